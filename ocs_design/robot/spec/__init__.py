"""The robot as a MuJoCo specification."""
