"""Pictures of bond graphs: half arrows and causal strokes, as SVG, PNG, PDF and text."""
