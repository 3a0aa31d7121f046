"""What a model does in numbers, with numpy alone; `to_python` writes these modules out whole."""
