"""Count the tests of a JUnit report: prints "PASSED FAILED". A test that did not run counts as failed."""

from __future__ import annotations

import argparse
import xml.etree.ElementTree as ET


def passed(case: ET.Element) -> bool:
    """Tell whether a test ran and succeeded."""
    bad = any(child.tag in ("failure", "error", "skipped") for child in case)
    return not bad and case.get("status", "run") == "run"


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition(":")[0])
    parser.add_argument("report", help="JUnit report (XML)")
    report = parser.parse_args().report
    try:
        outcomes = [passed(case) for case in ET.parse(report).iter("testcase")]
    except (OSError, ET.ParseError) as error:
        parser.error(f"{report} cannot be read: {error}")
    print(sum(outcomes), len(outcomes) - sum(outcomes))
