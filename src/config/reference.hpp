// Every key a configuration may have, for the configuration reference: made by the loader itself from the tables it
// checks against, so that the reference cannot say anything else.
#pragma once

#include <string>
#include <vector>

#include "config/key.hpp"

namespace pogosim {

struct KeyGroup {
    std::string path;  // of the map that holds the keys: "", "objects.<category>", ...
    std::string type;  // of objects: the value of `type`; else empty
    std::string doc;
    std::vector<KeyDescription> keys;
};

std::vector<KeyGroup> configuration_reference();

}  // namespace pogosim
