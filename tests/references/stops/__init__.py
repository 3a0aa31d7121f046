"""The judge of rigid bodies on lines with stops; `motion.Machine` runs one."""
