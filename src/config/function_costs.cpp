#include "config/object_parts.hpp"

#include <fmt/format.h>

#include <array>
#include <span>
#include <string>
#include <utility>

#include "config/included_files.hpp"

namespace pogosim {

namespace {

constexpr std::string_view kFile =
    "a file of costs has a map `function_costs`, such as function_costs: {user_step: {cycles: 25000}}, and nothing "
    "else; pogosim profile --costs FILE writes one";
constexpr std::string_view kMap = "a map of functions, such as {user_step: {cycles: 25000}}";

std::span<Key<FunctionCost> const> cost_keys() {
    using K = Key<FunctionCost>;
    static std::array const keys{
        K{"cycles", &FunctionCost::cycles, between(0, 1e12), "",
          "Cycles of a call, with all that it calls, on average, before `processor.cycle_factor`.",
          /*required=*/true},
        K{"library_us", &FunctionCost::library_us, between(0, 1e9), "us",
          "Time of a call in functions of the robot's library, besides."},
    };
    return keys;
}

}  // namespace

std::vector<FunctionCost> read_function_costs(MapReader& robot) {
    Node const* const node = robot.find("function_costs");
    std::vector<FunctionCost> costs;
    if (node == nullptr || !robot.reading().firmware.empty()) {  // firmware is in the place of the program
        return costs;
    }
    WrittenValue const written =
        value_or_file({*node, robot.path_of("function_costs")},
                      {"function_costs", kFunctionCosts, kFile, "the costs of functions"}, robot.reading());
    if (written.node.kind != Node::Kind::map) {
        fail_expected({written.node, written.path}, kMap);
    }
    Node values;
    values.kind = Node::Kind::map;
    for (auto const& [function, value] : written.node.entries) {
        FunctionCost cost{.function = function};
        MapReader reader(value, fmt::format("{}.{}", written.path, function), robot.reading());
        reader.read(cost_keys(), cost);
        reader.finish();
        values.entries.emplace_back(function, reader.values());
        costs.push_back(std::move(cost));
    }
    robot.set_value("function_costs", std::move(values));
    return costs;
}

std::vector<KeyDescription> function_cost_keys() {
    return described(cost_keys());
}

}  // namespace pogosim
