"""The paper's lower bound and the lightest rim for it."""
