// What the metadata of a data file say of the objects of a run.
#include <gtest/gtest.h>

#include <string>

#include "config/config_file.hpp"
#include "lamps/lamp_types.hpp"
#include "sim/build_world.hpp"
#include "sim/object_facts.hpp"

namespace pogosim {
namespace {

using config_file::Folder;

std::string facts_of(std::string const& objects, std::string const& top_level = "") {
    Folder const folder;
    Folder::write("arena.csv", "0,0\n1,0\n1,1\n0,1\n");
    Folder::write("x.yaml", "arena_file: arena.csv\narena_surface: 1e6\ninitial_formation: random\n" + top_level +
                                "objects:\n" + objects);
    Scenario const scenario = load_scenario("x.yaml", {}, object_types());
    return object_facts(scenario, build_world(scenario, 1));
}

TEST(ObjectFacts, SayTheirPartsAndTheirIds) {
    EXPECT_EQ(facts_of("  boxes: {type: passive_object, geometry: disk, radius: 10, nb: 4}\n"
                       "  beacons: {type: pogobject, geometry: disk, radius: 10, nb: 2, communication_radius: 50}\n"
                       "  robots: {type: pogobot, geometry: disk, nb: 3}\n"
                       "  none: {type: passive_object, geometry: disk, nb: 0}\n"),
              R"({"boxes":[{"type":"passive_object","has":["body"],"count":4,"first_id":65532}],)"
              R"("beacons":[{"type":"pogobject","has":["body","robot"],"count":2,"first_id":0,)"
              R"("infrared_range_mm":50}],)"
              R"("robots":[{"type":"pogobot","has":["body","robot","motors"],"count":3,"first_id":2,)"
              R"("infrared_range_mm":80,"top_speed_mm_s":100}],)"
              R"("none":[{"type":"passive_object","has":["body"],"count":0}]})");
}

TEST(ObjectFacts, SayWhatIsDrawnOfMembranesWallsAndLamps) {
    EXPECT_EQ(facts_of("  ring: {type: membrane, geometry: disk, radius: 60, dot_radius: 4}\n"
                       "  band: {type: rectmembrane, geometry: disk, radius: 60, rect_thickness: 6}\n"
                       "  wall: {type: pogowall, geometry: disk, radius: 5, x: 20, y: 30}\n"
                       "  sun: {type: orbiting_light, geometry: disk, radius: 100, nb: 2}\n"
                       "  tower: {type: rotating_ray_of_light, geometry: global}\n"),
              R"({"ring":[{"type":"membrane","has":["body","membrane","robot"],"count":1,"first_id":65535,)"
              R"("infrared_range_mm":80,"half_thickness_mm":4,"segments":false}],)"
              R"("band":[{"type":"rectmembrane","has":["body","membrane","robot"],"count":1,"first_id":65534,)"
              R"("infrared_range_mm":80,"half_thickness_mm":3,"segments":true}],)"
              R"("wall":[{"type":"pogowall","has":["robot"],"count":1,"first_id":65533,)"
              R"("infrared_range_mm":80,"position_mm":[20,30]}],)"
              R"("sun":[{"type":"orbiting_static_light","has":["lamp"],"count":2,"drawn_as":"spot"}],)"
              R"("tower":[{"type":"rotating_ray_of_light","has":["lamp"],"count":1,"drawn_as":"beam"}]})");
}

TEST(ObjectFacts, EntriesOfAListHaveIdsOfTheirOwn) {
    EXPECT_EQ(facts_of("  things:\n"
                       "    - {type: pogobot, geometry: disk, radius: 10, nb: 2}\n"
                       "    - {type: passive_object, geometry: disk, radius: 10, nb: 3}\n"),
              R"({"things":[{"type":"pogobot","has":["body","robot","motors"],"count":2,"first_id":0,)"
              R"("infrared_range_mm":80,"top_speed_mm_s":100},)"
              R"({"type":"passive_object","has":["body"],"count":3,"first_id":65533}]})");
}

TEST(ObjectFacts, WallsOfAPeriodicArenaAreNotThere) {
    config_file::Warnings const warnings;
    EXPECT_EQ(facts_of("  walls: {type: pogowall, geometry: arena}\n"
                       "  boxes: {type: passive_object, geometry: disk, radius: 10}\n",
                       "boundary_condition: periodic\n"),
              R"({"walls":[{"type":"pogowall","has":["robot"],"count":0,"infrared_range_mm":80}],)"
              R"("boxes":[{"type":"passive_object","has":["body"],"count":1,"first_id":65535}]})");
}

}  // namespace
}  // namespace pogosim
