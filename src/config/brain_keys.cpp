#include "config/object_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/counted.hpp"
#include "base/log.hpp"
#include "base/nearest_name.hpp"
#include "config/find_file.hpp"
#include "config/included_files.hpp"
#include "config/shape_keys.hpp"
#include "world/mailbox.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kBrain = "program, host, {script: FILE}, or a firmware, such as robot.elf";
constexpr std::string_view kScript = "the name of a file with a list `script`, or that list";
constexpr std::string_view kScriptFile =
    "a script has a list `script`, such as script: [{time_s: 0, motors: [500, 500, 0]}], and nothing else";
constexpr std::string_view kMotors = "a list of three powers, right, left and back, from -1023 to 1023";
constexpr std::string_view kLed = "a list of red, green and blue, from 0 to 255";

constexpr double kFullPower = 1023.0;

using Entry = ScriptSpec::Entry;

std::span<Key<Entry> const> entry_keys() {
    using K = Key<Entry>;
    static std::array const keys{
        K{"time_s", &Entry::time_s, between(0, 1e9), "s",
          "When: at the robot's first tick at or after this time of its own clock.", /*required=*/true},
        K{"motors", Elsewhere{kMotors}, any(), "", "Powers from then on; above 0: forwards."},
        K{"led", Elsewhere{kLed}, any(), "", "Colour of an LED from then on."},
        K{"led_id", &Entry::led_id, between(0, static_cast<int>(kLedCount) - 1).whole(), "",
          "Which LED; 0 is the head."}
            .only_if([](Entry const& entry) { return entry.led.has_value(); }),
        K{"message", &Entry::message, any(), "", "Text to send once, in all directions, up to 382 bytes."},
    };
    return keys;
}

/// The list of three whole numbers under a key.
std::array<int, 3> read_three(MapReader& reader, std::string_view key, Range const& range, std::string_view expected) {
    Place const place{*reader.find(key), reader.path_of(key)};
    if (place.node.kind != Node::Kind::sequence || place.node.items.size() != 3) {
        fail_expected(place, expected);
    }
    std::array<int, 3> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
        Place const item{place.node.items[i], fmt::format("{}.{}", place.path, i)};
        require_integers(item);
        read_value(item, Limits{range}, values[i]);
    }
    return values;
}

/// Powers that are meant as shares of full power would let the robot stand still.
void look_for_shares(Place const& motors) {
    std::vector<long> scaled;
    bool are_whole = true;
    if (motors.node.items.size() != kMotorCount) {
        return;
    }
    for (Node const& item : motors.node.items) {
        std::optional<double> const power = number_of(item);
        if (!power || std::abs(*power) > 1.0) {
            return;
        }
        scaled.push_back(std::lround(*power * kFullPower));
        are_whole = are_whole && std::trunc(*power) == *power;
    }
    if (std::ranges::all_of(scaled, [](long power) { return power == 0; })) {
        return;
    }
    std::string const hint = fmt::format("powers are from -1023 to 1023; if you meant shares of full power, write [{}]",
                                         fmt::join(scaled, ", "));
    if (!are_whole) {
        fail_at(motors, hint);
    }
    log().warn("{}: {}: {}", motors.node.where(), shown(motors.path), hint);
}

Entry read_entry(MapReader& reader) {
    Entry entry;
    if (reader.find("led") != nullptr) {
        auto const [red, green, blue] = read_three(reader, "led", between(0, 255), kLed);
        entry.led =
            Rgb{static_cast<std::uint8_t>(red), static_cast<std::uint8_t>(green), static_cast<std::uint8_t>(blue)};
    }
    if (reader.find("led_id") != nullptr && !entry.led) {
        reader.refuse("led_id",
                      "says which LED `led` colours, and there is no `led`; add one, such as led: [0, 255, 0]");
    }
    reader.read(entry_keys(), entry);
    if (Node const* const motors = reader.find("motors")) {
        look_for_shares({*motors, reader.path_of("motors")});
        std::ranges::copy(read_three(reader, "motors", between(-1023, 1023), kMotors), entry.motors.begin());
    }
    if (entry.message.size() > kMostPayloadBytes) {
        fail_at({*reader.find("message"), reader.path_of("message")},
                fmt::format("expected up to {} bytes, found {}", kMostPayloadBytes, entry.message.size()));
    }
    return entry;
}

bool drives(Entry const& entry) {
    return std::ranges::any_of(entry.motors, [](std::optional<int> const& power) { return power.has_value(); });
}

/// Whether the last entry sets at once what an earlier one of the same time has set.
bool replaces_earlier(std::vector<Entry> const& entries) {
    Entry const& entry = entries.back();
    for (std::size_t i = entries.size() - 1; i-- > 0 && entries[i].time_s == entry.time_s;) {
        bool const is_same_led = entries[i].led && entry.led && entries[i].led_id == entry.led_id;
        if (is_same_led || (drives(entries[i]) && drives(entry))) {
            return true;
        }
    }
    return false;
}

/// The last entry may leave no trace: with nothing in it, or in the place of an earlier one.
void warn_of_vain_entry(Place const& place, std::vector<Entry> const& entries) {
    auto const warn = [&](std::string_view what) {
        log().warn("{}: {}: {}", place.node.where(), shown(place.path), what);
    };
    Entry const& entry = entries.back();
    bool const is_empty = !drives(entry) && !entry.led && entry.message.empty();
    if (is_empty && place.node.find("led_id") == nullptr) {
        warn("has a time and nothing else, so it does nothing; add `motors`, `led` or `message`");
    } else if (replaces_earlier(entries)) {
        warn("replaces at once what an entry before it sets, which has the same time");
    }
}

/// Reads the list of a script. `values`: the same list as it counts.
ScriptSpec read_entries(Place const& place, Reading& reading, Node& values) {
    if (place.node.kind != Node::Kind::sequence) {
        fail_expected(place, "a list of maps, such as [{time_s: 0, motors: [500, 500, 0]}]");
    }
    ScriptSpec script;
    values.kind = Node::Kind::sequence;
    for (std::size_t i = 0; i < place.node.items.size(); ++i) {
        Node const& item = place.node.items[i];
        MapReader reader(item, fmt::format("{}.{}", place.path, i), reading);
        script.entries.push_back(read_entry(reader));
        reader.finish();
        values.items.push_back(reader.values());
        if (i > 0 && script.entries[i].time_s < script.entries[i - 1].time_s) {
            fail_at(reader.place(),
                    "the entries of a script are in the order of their times; this one is earlier than "
                    "the one before");
        }
        warn_of_vain_entry(reader.place(), script.entries);
    }
    return script;
}

std::span<Key<FirmwareSpec> const> firmware_keys() {
    using K = Key<FirmwareSpec>;
    static std::array const keys{
        K{"firmware", &FirmwareSpec::file, any(), "", "The ELF file, searched for like other files.",
          /*required=*/true},
        K{"random",
          one_of(&FirmwareSpec::random, {{"own", FirmwareRandom::own}, {"simulator", FirmwareRandom::simulator}}),
          any(), "",
          "Whose rand() and srand() it calls. own: those of its C library, as on the robot. simulator: those of a "
          "program in C, set by `seed`, to compare the two."},
        K{"columns", &FirmwareSpec::columns, any(), "",
          "Variables that become columns of the data file, such as [opinion, mydata.age, 'neighbours[0].id']: numbers "
          "and texts, by the debug information of the file."},
    };
    return keys;
}

/// Finds the file of a firmware.
void find_firmware(Place const& place, Reading& reading, FirmwareSpec& spec) {
    std::filesystem::path const found = find_file(place, reading.configuration, "an ELF file");
    reading.object_files.push_back({found, "the firmware"});
    spec.file = found.string();
}

FirmwareSpec read_firmware_map(MapReader& robot, Node const& brain) {
    FirmwareSpec spec;
    MapReader reader(brain, robot.path_of("brain"), robot.reading());
    reader.read(firmware_keys(), spec);
    reader.finish();
    find_firmware({*brain.find("firmware"), robot.path_of("brain") + ".firmware"}, robot.reading(), spec);
    robot.set_value("brain", reader.values());
    return spec;
}

/// What drives robots that need a program, where a firmware is in its place: it is one for robots, so walls and
/// membranes do nothing.
BrainSpec in_place_of_program(MapReader& robot, RobotModel const& model) {
    if (model.sends_along_outline) {
        return ScriptSpec();
    }
    Reading& reading = robot.reading();
    auto const is_it = [&](ObjectFile const& file) { return file.path == reading.firmware; };
    if (std::ranges::none_of(reading.object_files, is_it)) {
        reading.object_files.push_back({reading.firmware, "the firmware"});
    }
    Node value;
    value.kind = Node::Kind::scalar;
    value.scalar = reading.firmware;
    robot.set_value("brain", std::move(value));
    return FirmwareSpec{.file = reading.firmware};
}

ScriptSpec read_script(MapReader& robot, Node const& brain) {
    std::string const path = robot.path_of("brain");
    Node const* const script = brain.find("script");
    if (brain.entries.size() != 1 || script == nullptr) {
        fail_expected({brain, path}, kBrain);
    }
    WrittenValue const written =
        value_or_file({*script, path + ".script"}, {"script", kScript, kScriptFile, "the script"}, robot.reading());
    Node entries;
    ScriptSpec spec = read_entries({written.node, written.path}, robot.reading(), entries);
    Node value;
    value.kind = Node::Kind::map;
    value.entries.emplace_back("script", std::move(entries));
    robot.set_value("brain", std::move(value));
    return spec;
}

/// LEDs and motors that the robots do not have.
void check_parts(ScriptSpec const& script, RobotModel const& model, Place const& place) {
    constexpr std::array<std::string_view, kMotorCount> names{"right", "left", "back"};
    for (std::size_t motor = 0; motor < kMotorCount; ++motor) {
        auto const asks = [motor](Entry const& entry) { return entry.motors[motor].value_or(0) != 0; };
        if (!model.has_motor(static_cast<int>(motor)) && std::ranges::any_of(script.entries, asks)) {
            log().warn(
                "{}: {}: the script gives power to the {} motor, which these robots do not have; it moves nothing",
                place.node.where(), shown(place.path), names[motor]);
        }
    }
    for (ScriptSpec::Entry const& entry : script.entries) {
        if (entry.led && static_cast<std::size_t>(entry.led_id) >= model.leds.size()) {
            fail_at(place, fmt::format("the script sets LED {}, but these robots have {}", entry.led_id,
                                       counted(model.leds.size(), "LED")));
        }
    }
}

}  // namespace

std::span<Key<RobotSpec> const> brain_keys() {
    static std::array const keys{
        Key<RobotSpec>{"brain", Elsewhere{kBrain}, any(), "",
                       "What drives the robots. program: the program in C. host: the process that steps the run, such "
                       "as Python, by arrays. script: a list of what they do at which times; see its own table. The "
                       "name of an ELF file, or {firmware: FILE}: the firmware of robots. Default: program."},
        Key<RobotSpec>{
            "cpu_time",
            one_of(&RobotSpec::cpu_time,
                   {{"off", CpuTime::off}, {"counted", CpuTime::counted}, {"false", CpuTime::off}}),
            any(), "",
            "Whether the code of robots takes time. off, which YAML 1.1 reads as false: none. counted: as much as on "
            "the robot; of a firmware by the cycles of its instructions and the times of its calls (`processor`), of a "
            "program in C by `function_costs`."},
        Key<RobotSpec>{"function_costs", Elsewhere{kFunctionCosts}, any(), "",
                       "What the functions of a program in C take on the robot, with cpu_time: counted; see its own "
                       "table. pogosim profile --costs FILE measures it."},
    };
    return keys;
}

BrainSpec read_brain(MapReader& robot, RobotModel const& model) {
    Node const* const node = robot.find("brain");
    if (node == nullptr || node->scalar == "program") {
        return robot.reading().firmware.empty() ? ProgramSpec() : in_place_of_program(robot, model);
    }
    if (node->scalar == "host") {
        return HostSpec();
    }
    if (node->kind == Node::Kind::scalar && node->scalar.ends_with(".elf")) {
        FirmwareSpec spec{.file = node->scalar};
        find_firmware({*node, robot.path_of("brain")}, robot.reading(), spec);
        return spec;
    }
    if (node->kind != Node::Kind::map) {
        bool const is_file = node->scalar.ends_with(".yaml") || node->scalar.ends_with(".yml");
        std::string const hint = is_file
                                     ? fmt::format("; did you mean brain: {{script: {}}}?", shown(node->scalar))
                                     : did_you_mean(shown(node->scalar), std::vector<std::string>{"program", "host"});
        fail_at({*node, robot.path_of("brain")},
                fmt::format("expected {}, found {}{}", kBrain, found_text(*node), hint));
    }
    if (node->find("firmware") != nullptr && node->find("script") != nullptr) {
        fail_at({*node, robot.path_of("brain")}, "a script and a firmware exclude each other; remove one of them");
    }
    if (node->find("firmware") != nullptr) {
        return read_firmware_map(robot, *node);
    }
    ScriptSpec script = read_script(robot, *node);
    check_parts(script, model, {*node, robot.path_of("brain")});
    return script;
}

std::vector<KeyDescription> firmware_map_keys() {
    return described(firmware_keys());
}

std::vector<KeyDescription> script_entry_keys() {
    return described(entry_keys());
}

}  // namespace pogosim
