#include "config/reference.hpp"
#include "lamps/lamp_types.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

using namespace pogosim;

namespace {

KeyDescription const& key_of(std::vector<KeyGroup> const& groups, std::string const& type, std::string const& name) {
    static KeyDescription const none;
    for (KeyGroup const& group : groups) {
        auto const key = std::ranges::find(group.keys, name, &KeyDescription::name);
        if (group.type == type && key != group.keys.end()) {
            return *key;
        }
    }
    return none;
}

}  // namespace

TEST(Reference, EveryKeyHasALineOfDocumentationAndStandsOnce) {
    for (KeyGroup const& group : configuration_reference(object_types())) {
        std::set<std::string> seen;
        EXPECT_FALSE(group.doc.empty()) << group.path;
        for (KeyDescription const& key : group.keys) {
            EXPECT_FALSE(key.doc.empty()) << key.name;
            EXPECT_FALSE(key.expected.empty()) << key.name;
            EXPECT_TRUE(seen.insert(key.name).second) << key.name;
        }
    }
}

TEST(Reference, SaysWhatTheLoaderChecks) {
    std::vector<KeyGroup> const groups = configuration_reference(object_types());
    EXPECT_EQ(key_of(groups, "", "time_step").expected, "a number above 0, at most 1 (s)");
    EXPECT_EQ(key_of(groups, "", "time_step").default_text, "0.01");
    EXPECT_EQ(key_of(groups, "", "boundary_condition").expected, "solid or periodic");
    EXPECT_EQ(key_of(groups, "", "boundary_condition").default_text, "solid");
    EXPECT_EQ(key_of(groups, "", "seed").default_text, "");
    EXPECT_EQ(key_of(groups, "", "formation_max_space_between_neighbors").default_text, ".inf");
    EXPECT_EQ(key_of(groups, "", "initial_formation_center").default_text, "[.nan, .nan]");
    EXPECT_EQ(key_of(groups, "pogobot", "radius").default_text, "26.5");
    EXPECT_EQ(key_of(groups, "pogobot", "body_friction").default_text, "0.3");
    EXPECT_EQ(key_of(groups, "pogobot", "geometry").default_text, "disk");
    EXPECT_EQ(key_of(groups, "pogobject", "radius").default_text, "10");
    EXPECT_TRUE(key_of(groups, "pogobject", "geometry").required);
    EXPECT_EQ(key_of(groups, "", "arena_surface").default_text, "1000000");
    EXPECT_EQ(key_of(groups, "pogobot", "geometry").expected,
              "one of disk, rectangle, capsule, triangle, polygon, compound");
    EXPECT_EQ(key_of(groups, "static_light", "photo_start_value").default_text, "32767");
}
