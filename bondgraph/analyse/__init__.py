"""What derived equations are asked: loops, holding efforts, linear models."""
