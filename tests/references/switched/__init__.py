"""The judge of networks that switch: their voltages, currents and events without the toolkit."""
