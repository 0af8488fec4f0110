"""A run that goes on while others look at it: in a notebook, or in browsers."""
