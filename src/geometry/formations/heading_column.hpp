// Which column of a file of positions gives the headings, and what a run says about those that do not.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pogosim {

/// What was ignored of a file of positions, said once.
struct ImportRemark {
    std::string text{};       // empty: nothing
    bool is_warning = false;  // else it may well be intended
};

struct HeadingColumn {
    std::string_view name{};  // empty: there is none, so headings are drawn
    ImportRemark remark{};
};

/// 'theta', or else 'angle'. In a data file of ours, theta is a column of the program: a phase, for instance.
HeadingColumn heading_column(std::span<std::string const> names, bool is_data_file);

/// What to say of a file without a header whose rows have this many columns.
ImportRemark remark_without_header(std::size_t columns);

}  // namespace pogosim
