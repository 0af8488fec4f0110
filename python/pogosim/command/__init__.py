"""The command `pogosim` and its subcommands, one module each."""
