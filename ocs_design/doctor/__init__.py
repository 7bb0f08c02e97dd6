"""What is installed and works here. Nothing of it needs what may be missing."""
