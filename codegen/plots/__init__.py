"""Pictures of results: panels, poles, frequency responses, mode shapes."""
