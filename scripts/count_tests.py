"""Count the tests of a JUnit report: prints "PASSED FAILED". A test that did not run counts as failed."""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ET


def passed(case: ET.Element) -> bool:
    """Tell whether a test ran and succeeded."""
    bad = any(child.tag in ("failure", "error", "skipped") for child in case)
    return not bad and case.get("status", "run") == "run"


if __name__ == "__main__":
    outcomes = [passed(case) for case in ET.parse(sys.argv[1]).iter("testcase")]
    print(sum(outcomes), len(outcomes) - sum(outcomes))
