"""From a configuration with options to the configuration of each combination of them."""
