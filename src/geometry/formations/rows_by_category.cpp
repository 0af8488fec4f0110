#include "geometry/formations/rows_by_category.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "base/log.hpp"

namespace pogosim {

namespace {

std::string_view category_of(ImportedPose const& pose) {
    return pose.category ? std::string_view(*pose.category) : std::string_view();
}

/// Rows in the order of the objects, and then the others; empty if there are too few of a category.
std::vector<ImportedPose> sorted(std::vector<CategoryCount> const& wanted, std::vector<ImportedPose> const& poses) {
    std::map<std::string_view, std::vector<std::size_t>> rows;  // by category
    for (std::size_t i = 0; i < poses.size(); ++i) {
        rows[category_of(poses[i])].push_back(i);
    }
    std::map<std::string_view, std::size_t> used;
    std::vector<ImportedPose> found;
    std::vector<bool> is_left(poses.size(), true);
    for (auto const& [category, count] : wanted) {
        std::vector<std::size_t> const& own = rows[category];
        std::size_t& next = used[category];
        if (own.size() - next < count) {
            return {};
        }
        for (std::size_t const end = next + count; next < end; ++next) {
            found.push_back(poses[own[next]]);
            is_left[own[next]] = false;
        }
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (is_left[i]) {
            found.push_back(poses[i]);
        }
    }
    return found;
}

/// A file of one category may be meant for another one; too few rows are an error anyway.
void warn_of_other_categories(FormationSpec const& spec, std::vector<ImportedPose> const& poses) {
    std::set<std::string_view> categories;
    for (ImportedPose const& pose : poses) {
        categories.insert(category_of(pose));
    }
    std::vector<std::string_view> wanted;
    for (auto const& [category, count] : spec.categories) {
        wanted.insert(wanted.end(), count, category);
    }
    if (categories.size() < 2 || poses.size() < wanted.size()) {
        return;
    }
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (category_of(poses[i]) != wanted[i]) {
            log().warn(
                "{}:{}: this position of '{}' is taken for an object of '{}': the file has too few rows of that "
                "category with the first time value, so rows are taken in their order",
                spec.filename, poses[i].row, category_of(poses[i]), wanted[i]);
            return;
        }
    }
}

}  // namespace

void sort_by_category(FormationSpec const& spec, std::vector<ImportedPose>& poses) {
    auto const is_known = [](ImportedPose const& pose) { return pose.category != nullptr; };
    if (spec.categories.empty() || std::ranges::none_of(poses, is_known)) {
        return;
    }
    auto const is_of_others = [&](ImportedPose const& pose) {
        std::string_view const category = category_of(pose);
        return std::ranges::find(spec.categories, category, &CategoryCount::category) == spec.categories.end() &&
               std::ranges::find(spec.placed_apart, category) != spec.placed_apart.end();
    };
    std::erase_if(poses, [&](ImportedPose const& pose) { return pose.is_part || is_of_others(pose); });
    if (auto found = sorted(spec.categories, poses); !found.empty()) {
        poses = std::move(found);
    } else if (!spec.rows_of_others.may_follow) {  // for a file of several tasks, once
        warn_of_other_categories(spec, poses);
    }
}

}  // namespace pogosim
