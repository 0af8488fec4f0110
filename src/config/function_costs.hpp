// The key `function_costs` of a category: what the functions of a program in C take on the robot's processor.
#pragma once

#include <string_view>
#include <vector>

#include "config/map_reader.hpp"
#include "world/processor_spec.hpp"

namespace pogosim {

inline constexpr std::string_view kFunctionCosts = "the name of a file with a map `function_costs`, or that map";

/// Without the key, none. Throws ConfigError.
std::vector<FunctionCost> read_function_costs(MapReader& robot);

/// The keys of one function, for the configuration reference.
std::vector<KeyDescription> function_cost_keys();

}  // namespace pogosim
