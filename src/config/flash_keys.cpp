#include "config/scenario_keys.hpp"

#include <array>
#include <span>

namespace pogosim {

namespace {

std::span<Key<FlashStateConfig> const> flash_state_keys() {
    using K = Key<FlashStateConfig>;
    static std::array const keys{
        K{"input_file", &FlashStateConfig::input_file, any(), "",
          "Archive from which robots get their flash memory, and the directions and powers of motors that they store, "
          "before the program starts. Relative to the working folder. Empty: flash memory is blank."},
        K{"output_file", &FlashStateConfig::output_file, any(), "",
          "Archive that a run writes when it ends normally; it may be the input file. Relative to the working folder; "
          "missing folders are created. Empty: none."},
        K{"create_if_missing", &FlashStateConfig::create_if_missing, any(), "",
          "If there is no input file, an archive without records is written in its place, and flash memory is blank; "
          "false: that is an error."}
            .only_if([](FlashStateConfig const& state) { return !state.input_file.empty(); }),
    };
    return keys;
}

}  // namespace

NamedValues<std::optional<FlashWrites>> flash_writes() {
    return {{"overwrite", FlashWrites::overwrite}, {"nor", FlashWrites::nor}};
}

FlashStateConfig read_flash_state_map(MapReader& reader) {
    FlashStateConfig state;
    reader.read(flash_state_keys(), state);
    return state;
}

FlashStateConfig read_flash_state(MapReader& top) {
    FlashStateConfig state;
    top.read_map("flash_state", kFlashStateMap, [&](MapReader& map) { state = read_flash_state_map(map); });
    return state;
}

}  // namespace pogosim
