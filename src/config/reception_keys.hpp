// `msg_success_rate`: the probability that a message is received.
#pragma once

#include <string_view>

#include "config/map_reader.hpp"
#include "world/specs.hpp"

namespace pogosim {

inline constexpr std::string_view kReceptionMap = "a map of keys, such as {type: static, rate: 0.9}";

/// The law a robot's `msg_success_rate` asks for; `robot` reads the map it stands in.
///
///   absent      the article's equation with its defaults
///   static      P = rate
///   realistic   the four-parameter law with its own defaults, whatever else the map holds
///   dynamic     with alpha, beta, gamma or delta, but neither zeta nor theta: the four-parameter law;
///               otherwise the article's equation. Parameters that are not given have the defaults of the law.
ReceptionSpec read_reception(MapReader& robot);

/// The same from the map `msg_success_rate` itself; the caller finishes the reader.
ReceptionSpec read_reception_map(MapReader& reader);

}  // namespace pogosim
