#include "config/reference.hpp"

#include <fmt/format.h>

#include <utility>

#include "config/object_parts.hpp"
#include "config/object_types.hpp"
#include "config/scenario_keys.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

std::vector<KeyGroup> configuration_reference(ObjectTypes const& types) {
    Node const nothing;
    Reading reading;
    std::vector<KeyGroup> groups;

    MapReader top(nothing, "", reading);
    Scenario scenario;
    read_top_level(top, scenario);
    groups.push_back({"", "", "Top level.", top.known_keys()});

    for (ObjectType const& type : types) {
        MapReader reader(nothing, "objects.<category>", reading);
        ObjectConfig object;
        reader.read(types.common_keys(), object);
        type.read(reader, object);
        groups.push_back({"objects.<category>", std::string(type.name), std::string(type.doc), reader.known_keys()});
    }

    groups.push_back({"objects.<category>.parts.<number>", "", "A part of a compound.", shape_part_keys()});

    MapReader area(nothing, "objects.<category>.area", reading);
    read_disk_area(area);
    groups.push_back(
        {"objects.<category>.area", "", "A disk; the other form is a list of corners.", area.known_keys()});

    MapReader reception(nothing, "objects.<category>.msg_success_rate", reading);
    read_reception_map(reception);
    groups.push_back({"objects.<category>.msg_success_rate", "", "Reception of messages.", reception.known_keys()});

    MapReader battery(nothing, "objects.<category>.battery", reading);
    read_battery_map(battery);
    groups.push_back({"objects.<category>.battery", "", "A battery that empties.", battery.known_keys()});

    groups.push_back(
        {"objects.<category>.brain.script.<number>", "", "What a script does at a time.", script_entry_keys()});

    groups.push_back({"objects.<category>.brain", "", "A firmware.", firmware_map_keys()});

    groups.push_back({"objects.<category>.function_costs.<function>", "",
                      "What a call of a function of a program in C takes on the robot.", function_cost_keys()});

    for (ModelTable& table : model_tables()) {
        groups.push_back(
            {fmt::format("objects.<category>.{}", table.name), "", std::string(table.doc), std::move(table.keys)});
    }

    groups.push_back({"links.<name>", "", "Links between objects.", link_keys_reference()});

    MapReader magnetometer(nothing, "magnetometer", reading);
    read_magnetometer_map(magnetometer);
    groups.push_back({"magnetometer", "", "What the magnetometers of robots measure.", magnetometer.known_keys()});

    MapReader flash_state(nothing, "flash_state", reading);
    read_flash_state_map(flash_state);
    groups.push_back({"flash_state", "", "Flash memory from one run to the next.", flash_state.known_keys()});

    MapReader view(nothing, "view", reading);
    read_view_map(view, scenario.view);
    groups.push_back({"view", "", "What the window, frames and films show.", view.known_keys()});
    return groups;
}

}  // namespace pogosim
