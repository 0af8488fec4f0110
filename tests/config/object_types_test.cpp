// The types of objects have the parts that docs/new_object_type.md says.
#include "lamps/lamp_types.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "config_file.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

/// A row of the page's table: | types | shape | body | membrane | robot | lamp |
struct Row {
    std::string types;
    std::string shape;
    std::string parts;  // body, membrane, robot and lamp
};

std::vector<Row> rows_of_the_page() {
    std::ifstream page(std::string(POGOSIM_SOURCE_DIR) + "/docs/new_object_type.md");
    std::vector<Row> rows;
    for (std::string line; std::getline(page, line);) {
        std::vector<std::string> cells;
        std::istringstream text(line);
        for (std::string cell; std::getline(text, cell, '|');) {
            auto const first = cell.find_first_not_of(' ');
            cells.push_back(first == std::string::npos ? ""
                                                       : cell.substr(first, cell.find_last_not_of(' ') + 1 - first));
        }
        if (cells.size() == 7 && cells[1].starts_with('`') && cells[1] != "`type`") {
            rows.push_back({cells[1], cells[2], cells[3] + "|" + cells[4] + "|" + cells[5] + "|" + cells[6]});
        }
    }
    return rows;
}

std::string described(RobotSpec const& robot) {
    std::string text = robot.model.has_motors() ? "" : "no wheels";
    if (robot.model.sends_along_outline) {
        text += ", emitters along the outline";
    } else if (robot.model.faces[0].place == PartPlace()) {
        text += ", emitters in the centre";
    }
    return text.empty() ? "yes" : text;
}

std::string parts_of(ObjectSpec const& spec) {
    return std::string(spec.body ? "yes" : "") + "|" + (spec.membrane ? "yes" : "") + "|" +
           (spec.robot ? described(*spec.robot) : "") + "|" + (spec.lamp ? "yes" : "");
}

std::string object(std::string const& type, std::string const& geometry) {
    return "objects: {o: {type: " + type + ", x: 500, y: 500, geometry: " + geometry + "}}\n";
}

/// The row that names the type; lamps that move are in the row of `static_light`.
Row const* row_of(std::vector<Row> const& rows, std::string const& type) {
    for (Row const& row : rows) {
        if (row.types.find("`" + type + "`") != std::string::npos) {
            return &row;
        }
    }
    return type == "static_light" ? nullptr : row_of(rows, "static_light");
}

TEST(ObjectTypes, HaveThePartsThatThePageSays) {
    Warnings const warnings;
    std::vector<Row> const rows = rows_of_the_page();
    ASSERT_EQ(rows.size(), 7U);
    for (ObjectType const& type : object_types()) {
        std::string const name(type.name);
        Row const* const row = row_of(rows, name);
        ASSERT_NE(row, nullptr) << name;
        EXPECT_EQ(parts_of(load(object(name, "disk")).objects.at(0).spec), row->parts) << name;
    }
}

TEST(ObjectTypes, HaveTheShapesThatThePageSays) {
    Warnings const warnings;
    std::vector<Row> const rows = rows_of_the_page();
    for (ObjectType const& type : object_types()) {
        std::string const name(type.name);
        std::string const shape = row_of(rows, name)->shape;
        for (char const* const geometry :
             {"disk", "rectangle", "triangle", "capsule", "polygon, corners: [[0, 0], [40, 0], [20, 30]]"}) {
            EXPECT_NO_THROW((void)load(object(name, geometry))) << name << ", " << geometry;
        }
        bool const any = shape.starts_with("any");
        auto const may_be = [&](char const* geometry) {
            try {
                (void)load(object(name, geometry));
                return true;
            } catch (ConfigError const&) {
                return false;
            }
        };
        EXPECT_EQ(may_be("arena"), any || shape.find("arena") != std::string::npos) << name;
        EXPECT_EQ(may_be("global"), any) << name;
        EXPECT_EQ(may_be("compound, parts: [{geometry: disk}]"), shape == "solid") << name;
    }
}

}  // namespace
