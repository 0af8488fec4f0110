"""Files include what they use of the standard library and of fmt. Headers of libraries may stop bringing it along."""

from __future__ import annotations

import functools
import re
from pathlib import Path

import pytest
from running import ROOT

# Names, as an expression behind "std::" or "fmt::", and the headers any of which gives them.
STANDARD = {
    "numeric_limits": "limits",
    r"u?int(8|16|32|64|ptr|max)_t": "cstdint",
    r"(s?size|ptrdiff)_t": "cstddef cstdint cstdio cstdlib cstring ctime string string_view vector array span",
    r"(ranges::)?(sort|stable_sort|find|find_if|find_if_not|any_of|all_of|none_of|min|max|minmax|clamp|min_element|"
    r"max_element|lower_bound|upper_bound|fill|fill_n|copy_if|count|count_if|reverse|unique|remove|remove_if|transform|"
    r"replace|replace_if|equal|generate|nth_element|rotate|for_each|copy_n|partition|adjacent_find|mismatch|shuffle)"
    r"(?=\(|<)": "algorithm",
    r"(accumulate|iota|inner_product|partial_sum|reduce|gcd|lcm)": "numeric",
    r"(sqrt|hypot|sin|cos|tan|atan2|atan|asin|acos|exp|log|pow|floor|ceil|round|lround|isfinite|isnan|fmod|remainder|"
    r"fabs|copysign|cbrt|trunc|nextafter|log2|log10|llround|nearbyint|ldexp|frexp)": "cmath",
    r"array(?=<|\s+const)": "array",
    "vector": "vector",
    "span": "span",
    "map": "map",
    "multimap": "map",
    "set": "set",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "deque": "deque",
    "optional": "optional",
    "nullopt": "optional",
    "variant": "variant",
    "visit": "variant",
    "get_if": "variant",
    "holds_alternative": "variant",
    "function": "functional",
    r"(unique_ptr|shared_ptr|weak_ptr|make_unique|make_shared)": "memory",
    r"string": "string",
    r"to_string": "string",
    r"string_view": "string_view",
    r"(pair|exchange|move|forward|as_const)": "utility algorithm map vector string memory optional variant "
    "functional tuple",
    r"(tuple|tie|make_tuple)": "tuple",
    r"(runtime_error|logic_error|invalid_argument|out_of_range)": "stdexcept",
    r"(exception|exception_ptr|current_exception|terminate|set_terminate)": "exception stdexcept",
    r"bad_alloc": "new",
    r"[io]?stringstream": "sstream",
    r"[io]?fstream": "fstream",
    r"(cout|cerr|cin)": "iostream",
    r"filesystem": "filesystem",
    r"chrono": "chrono",
    r"numbers": "numbers",
    r"(bit_cast|popcount|countr_zero|countl_zero|bit_width|bit_ceil)": "bit",
    r"(atomic|atomic_flag|memory_order_\w+)": "atomic",
    r"(thread|this_thread)": "thread",
    r"(mutex|lock_guard|unique_lock|call_once|once_flag)": "mutex",
    r"(memcpy|memset|memmove|memcmp|strlen|strcmp|strncmp|strerror|strchr|strrchr)": "cstring",
    r"(printf|fprintf|snprintf|vsnprintf|fputs|fputc|fopen|fclose|fflush|fwrite|FILE|remove(?=\(\w+\.c_str))": "cstdio",
    r"(abort|exit|_Exit|getenv|strtod|strtol|strtoull|free|malloc|abs|div)": "cstdlib cmath",
    r"(va_list)": "cstdarg",
    r"(regex|smatch|regex_\w+)": "regex",
    r"(from_chars|to_chars)": "charconv",
    r"(errc|error_code|system_error)": "system_error filesystem",
    r"(same_as|integral|floating_point|invocable)": "concepts",
    r"(is_same_v|is_arithmetic_v|is_floating_point_v|is_integral_v|decay_t|enable_if_t|remove_cvref_t|conditional_t|"
    r"underlying_type_t|is_trivially_copyable_v|is_signed_v|make_unsigned_t|invoke_result_t)": "type_traits",
    r"(size|begin|end|distance|next|prev|back_inserter|make_move_iterator|advance|data)(?=\()": "iterator vector array "
    "string string_view map set span deque",
    r"type_index": "typeindex",
    r"initializer_list": "initializer_list vector string map set",
}
FMT = {
    r"join\(": "fmt/ranges.h",
    r"(format|print|runtime|format_to|memory_buffer|formatter|format_string)\b": "fmt/format.h fmt/ranges.h fmt/core.h",
}
FOLDERS = ["bench", "docs", "src", "tests", "tools"]


def sources() -> list[Path]:
    return [path for folder in FOLDERS for path in (ROOT / folder).rglob("*.?pp") if "programs" not in path.parts]


@functools.cache
def includes(path: Path) -> frozenset[str]:
    """Return the headers that a file includes, by itself or through headers of the project."""
    found: set[str] = set()
    for name in re.findall(r'^#include ["<]([^">]+)', path.read_text(), re.MULTILINE):
        found.add(name)
        places = (folder / name for folder in (path.parent, ROOT / "src", ROOT / "tests", ROOT / "include"))
        found.update(*(includes(place) for place in places if place.is_file()))
    return frozenset(found)


def without_comments_and_texts(code: str) -> str:
    code = re.sub(r'R"(\w*)\(.*?\)\1"', '""', code, flags=re.DOTALL)
    code = re.sub(r'"(?:[^"\\\n]|\\.)*"', '""', code)
    return re.sub(r"//.*|/\*.*?\*/", "", code)


@pytest.mark.parametrize(("prefix", "names"), [("std", STANDARD), ("fmt", FMT)], ids=["std", "fmt"])
def test_no_file_relies_on_what_library_headers_happen_to_include(prefix: str, names: dict[str, str]) -> None:
    patterns = {
        re.compile(rf"\b{prefix}::{name}" + ("" if name.endswith(("(", ")")) else r"\b")): headers.split()
        for name, headers in names.items()
    }
    missing = []
    assert len(sources()) > 100
    for path in sources():
        code = without_comments_and_texts(path.read_text())
        have = includes(path)
        for pattern, headers in patterns.items():
            used = pattern.search(code)
            if used and not have.intersection(headers):
                missing.append(f"{path.relative_to(ROOT)}: {used[0]} needs <{headers[0]}>")
    assert missing == []
