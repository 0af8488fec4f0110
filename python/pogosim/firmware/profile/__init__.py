"""Where the cycles of a tick go: reports of the profile that the simulator writes of a firmware (`--profile FILE`).

`raw` reads that file and describes it; `costs` and `load` add up; `report`, `table`, `flame` and `trace` write what
people, spreadsheets, browsers and trace viewers read; `advice` says what to change.
"""
