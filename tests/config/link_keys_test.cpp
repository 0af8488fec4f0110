// `links` of a configuration: keys, defaults and mistakes.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "config/reference.hpp"
#include "config/source.hpp"
#include "config_file.hpp"
#include "lamps/lamp_types.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

/// Lines 1 to 7; those of a test begin at 8.
std::string const kScene =
    "initial_formation: lattice\n"
    "objects:\n"
    "  robots: {type: pogobot, geometry: disk, nb: 7}\n"
    "  box: {type: passive_object, geometry: rectangle, x: 100, y: 100}\n"
    "  post: {type: passive_object, geometry: disk, x: 300, y: 100, body_fixed: true}\n"
    "links:\n"
    "  skin:\n";

std::string entry(std::string const& keys) {
    return kScene + keys;
}

LinkConfig link(std::string const& keys) {
    return load(entry(keys)).links.at(0);
}

std::string error(std::string const& keys) {
    Warnings const warnings;
    return load_error(entry(keys));
}

std::string const kChain = "    between: robots\n    topology: chain\n";

}  // namespace

TEST(Links, DefaultsAreASpringBetweenCentresOfItsInitialLength) {
    Warnings const warnings;
    LinkConfig const spring = link(kChain);
    EXPECT_EQ(spring.name, "skin");
    EXPECT_EQ(spring.kind, LinkKind::spring);
    EXPECT_EQ(spring.between, std::vector<std::string>{"robots"});
    EXPECT_EQ(spring.topology, LinkTopology::chain);
    EXPECT_EQ(spring.which, LinkedObjects::all);
    EXPECT_EQ(spring.rest_length_mm, std::nullopt);
    EXPECT_EQ(spring.stiffness_n_m, 10.0F);
    EXPECT_EQ(spring.damping_n_s_m, 1.0F);
    EXPECT_EQ(spring.breaking_force_n, std::nullopt);
    EXPECT_EQ(spring.limits_deg, std::nullopt);
    EXPECT_EQ(spring.attach, LinkAttachment::centre);
    EXPECT_TRUE(spring.visible);
    EXPECT_EQ(warnings.text(), "");
    EXPECT_TRUE(load(kRobots).links.empty());
}

TEST(Links, EveryKeyIsRead) {
    Warnings const warnings;
    LinkConfig const spring = link(
        "    type: spring\n    between: [robots, box]\n    topology: nearest\n    neighbors: 2\n"
        "    max_distance: 90\n    which: [0, 3]\n    rest_length: 50\n    stiffness: 3\n    damping: 0\n"
        "    breaking_force: 0.5\n    attach: rim\n    visible: false\n");
    EXPECT_EQ(spring.between, (std::vector<std::string>{"robots", "box"}));
    EXPECT_EQ(spring.topology, LinkTopology::nearest);
    EXPECT_EQ(spring.neighbours, 2);
    EXPECT_EQ(spring.max_distance_mm, 90.0);
    EXPECT_EQ(spring.which, LinkedObjects::numbers);
    EXPECT_EQ(spring.numbers, (std::vector<std::uint32_t>{0, 3}));
    EXPECT_EQ(spring.rest_length_mm, 50.0);
    EXPECT_EQ(spring.stiffness_n_m, 3.0F);
    EXPECT_EQ(spring.damping_n_s_m, 0.0F);
    EXPECT_EQ(spring.breaking_force_n, 0.5F);
    EXPECT_EQ(spring.attach, LinkAttachment::rim);
    EXPECT_FALSE(spring.visible);
    LinkConfig const hinge = link("    type: hinge\n" + kChain + "    limits: [-20, 35]\n");
    EXPECT_EQ(hinge.kind, LinkKind::hinge);
    EXPECT_EQ(hinge.limits_deg, (Interval{-20.0, 35.0}));
    LinkConfig const rod = link("    type: rod\n" + kChain + "    attach: [10, -5]\n    rest_length: initial\n");
    EXPECT_EQ(rod.kind, LinkKind::rod);
    EXPECT_EQ(rod.attach, LinkAttachment::place);
    EXPECT_EQ(rod.attach_mm, (Vec2{10.0F, -5.0F}));
    EXPECT_EQ(rod.rest_length_mm, std::nullopt);
    EXPECT_EQ(link("    between: robots\n    topology: nearest\n    neighbours: 3\n").neighbours, 3);
    EXPECT_EQ(link(kChain + "    attach: centre\n").attach, LinkAttachment::centre);
    EXPECT_EQ(link("    between: robots\n    topology: fixed\n    which: rim\n").which, LinkedObjects::rim);
    EXPECT_EQ(warnings.text(), "");
}

TEST(Links, ValuesOfTheWrongKindAreRefusedWithTheirLine) {
    std::vector<std::pair<std::string, std::string>> const cases{
        {"type: glue", "type: expected one of spring, rod, hinge, found 'glue'"},
        {"stiffness: 0", "stiffness: expected a number above 0, at most 1000000000 (N/m), found 0"},
        {"damping: -1", "damping: expected a number from 0 to 1000000000 (N s/m), found -1"},
        {"breaking_force: 0", "breaking_force: expected a number above 0, at most 1000000000 (N), found 0"},
        {"rest_length: -1", "rest_length: expected a number from 0 to 1000000 (mm), or 'initial', found -1"},
        {"attach: left", "attach: expected center, rim, or a list [x, y] of numbers (mm), found 'left'"},
        {"which: some", "which: expected all, rim, or a list of numbers from 0, found 'some'"},
        {"which: []", "which: expected all, rim, or a list of numbers from 0, found a list"},
        {"which: [1, 1]", "which: the number 1 stands twice"},
        {"which: [0, 9]", "which: there is no object 9 of 'robots'; their numbers are 0 to 6"},
        {"which: [0]", "which: a chain needs at least 2 objects, found 1"},
        {"which: rim", "which: 'rim' is for topology fixed; list the numbers of the objects"},
        {"visible: perhaps", "visible: expected true or false, found 'perhaps'"},
    };
    for (auto const& [key, message] : cases) {
        EXPECT_EQ(error(kChain + "    " + key + "\n"), "x.yaml:10: links.skin." + message);
    }
    EXPECT_EQ(error("    type: hinge\n" + kChain + "    limits: [5, 20]\n"),
              "x.yaml:11: links.skin.limits: expected two angles with 0, the angle at the start, between them, found "
              "[5, 20]");
    EXPECT_EQ(error("    type: hinge\n" + kChain + "    limits: [-200, 20]\n"),
              "x.yaml:11: links.skin.limits.0: expected a number from -180 to 180 (degrees), found -200");
}

TEST(Links, CategoriesHaveToBeThereAndToHaveOneBodyEach) {
    auto const between = [](std::string const& value) {
        return error("    between: " + value + "\n    topology: nearest\n");
    };
    std::string const where = "x.yaml:8: links.skin.between: ";
    EXPECT_EQ(between("robot"), where +
                                    "there is no category 'robot' in 'objects' (those with bodies: robots, box, post); "
                                    "did you mean 'robots'?");
    EXPECT_EQ(between("post"), where + "'post' cannot move (body_fixed), so the links would do nothing");
    EXPECT_EQ(between("[robots, post]"), "no error");
    EXPECT_EQ(between("[robots, robots]"), "no error");
    EXPECT_EQ(between("[]"), where + "expected a category of objects, or a list of two, found a list");
    EXPECT_TRUE(
        between("[a, b, c]").starts_with(where + "expected a category of objects, or a list of two, found a list"));
    auto const with = [](std::string const& object) {
        Warnings const warnings;
        return load_error("objects:\n  robots: {type: pogobot}\n  it: " + object +
                          "\nlinks:\n  skin: {between: [robots, it], topology: nearest}\n");
    };
    std::string const other = "; links hold robots and passive objects of one body each";
    std::string const line = "x.yaml:5: links.skin.between: 'it' ";
    EXPECT_EQ(with("{type: membrane, geometry: disk, radius: 90}"), line + "is a membrane, of many bodies" + other);
    EXPECT_EQ(with("{type: pogowall, geometry: arena}"), line + "has no body" + other);
    EXPECT_EQ(with("{type: static_light, geometry: disk}"), line + "is a lamp" + other);
    EXPECT_EQ(with("{type: pogobot, nb: 0}"), line + "has no objects (nb: 0)");
    EXPECT_EQ(with("{type: pogobject, geometry: disk}"), "no error");
}

TEST(Links, TopologiesSayWhatTheyNeed) {
    std::string const where = "x.yaml:8: links.skin.";
    EXPECT_EQ(error("    between: [robots, box]\n    topology: chain\n"),
              where +
                  "between: chain, ring and fixed take one category; to link two of them, use topology nearest, list, "
                  "triangular or square");
    EXPECT_EQ(error("    between: box\n    topology: ring\n"),
              where + "between: a ring needs at least 3 objects, found 1");
    EXPECT_EQ(error("    topology: square\n    between: robots\n"),
              where + "topology: the lattice is triangular (lattice_kind); set both alike");
    EXPECT_EQ(error("    topology: triangular\n    between: [robots, box]\n"),
              where +
                  "topology: needs objects in a lattice, and 'box' has places of its own (x and y, or poses); set "
                  "initial_formation: lattice in their place");
    EXPECT_EQ(load_error(kRobots + "links: {skin: {between: robots, topology: triangular}}\n"),
              "x.yaml:6: links.skin.topology: needs objects in a lattice, and 'robots' is placed by 'power_lloyd'; set "
              "initial_formation: lattice, or choose another topology");
    EXPECT_EQ(load_error(kRobots + "    initial_formation: aligned_lattice\n"
                                   "links: {skin: {between: robots, topology: triangular}}\n"),
              "no error");
    EXPECT_EQ(load_error(kRobots + "links: {skin: {between: robots, topology: fixed, which: rim}}\n"),
              "x.yaml:6: links.skin.which: needs objects in a lattice, and 'robots' is placed by 'power_lloyd'; set "
              "initial_formation: lattice, or choose another topology");
    EXPECT_EQ(error("    between: robots\n"),
              "x.yaml:7: links.skin: the key 'topology' is missing; expected one of triangular, square, chain, ring, "
              "nearest, list, fixed");
    EXPECT_EQ(error("    topology: chain\n"),
              "x.yaml:7: links.skin: the key 'between' is missing; expected a category of objects, or a list of two");
    EXPECT_EQ(error("    topology: fixed\n    between: robots\n    attach: rim\n"),
              "x.yaml:10: links.skin.attach: there is no other end that a point of the rim could face; use center or "
              "[x, y], or a file with places");
    EXPECT_EQ(error("    type: rod\n    topology: fixed\n    between: robots\n"),
              where + "type: a rod needs a length (rest_length); to pin a point, use a hinge");
    EXPECT_EQ(error("    type: rod\n" + kChain + "    rest_length: 0\n"),
              where + "type: a rod needs a length (rest_length); to pin a point, use a hinge");
}

TEST(Links, FilesAreFoundBesideTheConfiguration) {
    EXPECT_EQ(
        error("    between: robots\n    topology: list\n"),
        "x.yaml:7: links.skin.file: expected the name of a CSV file with columns a and b; 'topology: list' needs it");
    std::string const missing = error("    between: robots\n    topology: list\n    file: none.csv\n");
    EXPECT_TRUE(missing.starts_with("x.yaml:10: links.skin.file: there is no file 'none.csv'; searched ")) << missing;
    EXPECT_EQ(error("    between: robots\n    topology: list\n    file: .\n"),
              "x.yaml:10: links.skin.file: '.' is a folder; expected a CSV file");
    Folder const folder;
    std::filesystem::create_directory("conf");
    Folder::write("conf/pairs.csv", "a,b\n0,1\n");
    Folder::write("conf/x.yaml", entry("    between: robots\n    topology: list\n    file: pairs.csv\n"));
    Scenario const scenario = load_scenario("conf/x.yaml", {}, object_types());
    EXPECT_EQ(scenario.links.at(0).found_file, std::filesystem::path("conf/pairs.csv"));
    EXPECT_EQ(scenario.object_files.at(0).path, std::filesystem::path("conf/pairs.csv"));
}

TEST(Links, KeysWithoutAMeaningAreTold) {
    Warnings const warnings;
    load(entry(kChain + "    limits: [-5, 5]\n    neighbors: 3\n    file: none.csv\n"));
    EXPECT_EQ(warnings.text(),
              "x.yaml:11: links.skin: neighbors, file, limits have no effect with type spring and topology chain\n");
    Warnings const others;
    load(entry("    type: hinge\n" + kChain + "    stiffness: 3\n"));
    EXPECT_EQ(others.text(), "x.yaml:11: links.skin: stiffness has no effect with type hinge and topology chain\n");
}

TEST(Links, UnknownKeysAndNamesAreToldWithTheNearestOne) {
    Warnings const warnings;
    load(entry(kChain + "    stifness: 3\n"));
    EXPECT_NE(warnings.text().find("did you mean 'stiffness'?"), std::string::npos) << warnings.text();
    std::string const text = entry(kChain);
    EXPECT_EQ(load(text, {.overrides = {"links.skin.stiffness=3"}}).links.at(0).stiffness_n_m, 3.0F);
    EXPECT_EQ(load_error(text, {.overrides = {"links.skim.stiffness=3"}}),
              "--set: links: unknown links 'skim' (known: skin); did you mean 'skin'?");
    EXPECT_EQ(load(text, {.overrides = {"links.more={between: robots, topology: ring}"}}).links.size(), 2U);
    EXPECT_EQ(load_error(kRobots + "links: [1]\n"),
              "x.yaml:6: links: expected a map of links, such as {skeleton: {between: robots, topology: triangular}}, "
              "found a list");
    EXPECT_EQ(load_error(kRobots + "links: {skin: 3}\n"), "x.yaml:6: links.skin: expected a map of keys, found 3");
    EXPECT_TRUE(load(kRobots + "links:\n").links.empty());
}

TEST(Links, OptionsOfBatchesStandInThem) {
    Warnings const warnings;
    EXPECT_EQ(link(kChain + "    stiffness: {default_option: 4, batch_options: [1, 4, 9]}\n").stiffness_n_m, 4.0F);
}

TEST(Links, ValuesInUseAreReadBackAsTheyAre) {
    Scenario const scenario = load(
        "arena_file: arenas/disk.csv\n" +
        entry("    type: hinge\n    between: robots\n    topology: ring\n    which: [0, 2, 1]\n    limits: [-5, 5]\n"));
    Node const& values = *find_path(scenario.source->values, "links.skin");
    EXPECT_EQ(values.find("topology")->scalar, "ring");
    EXPECT_EQ(values.find("stiffness"), nullptr);
    Folder const folder;
    Warnings const warnings;
    std::string const text = to_yaml(scenario.source->values);
    Folder::write("values.yaml", text);
    EXPECT_EQ(to_yaml(load_scenario("values.yaml", {.overrides = {}, .strict = true}, object_types()).source->values),
              text);
    EXPECT_EQ(warnings.text(), "");
}
