#include "robot/portable_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/error.hpp"

namespace pogosim {

namespace {

constexpr std::uint32_t kProgram = 0;
constexpr std::uint32_t kUserData = 1;
constexpr std::size_t kWord = sizeof(std::uint64_t);
// Below, where the heap of an executable without random addresses (-no-pie) is, a number is more likely.
constexpr std::uint64_t kLeastForeign = std::uint64_t{1} << 32U;

}  // namespace

AddressRegions::AddressRegions(ProgramImage const& image, std::span<std::byte const> user_data)
    : mapped_(mapped_memory()) {
    std::vector<LoadedModule> const modules = loaded_modules();
    LoadedModule const* const program = module_at(modules, reinterpret_cast<void const*>(image.main));
    regions_.push_back({"the program", {}, 0, 0});
    if (program != nullptr) {
        regions_[kProgram] = {"the program", program->build, program->begin, program->end};
    }
    auto const begin = reinterpret_cast<std::uint64_t>(user_data.data());
    regions_.push_back({"user data", {}, begin, begin + user_data.size()});
    for (LoadedModule const& module : modules) {
        if (&module != program) {
            regions_.push_back({module.name, module.build, module.begin, module.end});
        }
    }
}

void AddressRegions::append_names(StateWriter& state) const {
    state(regions_.size());
    for (Region const& region : regions_) {
        state(region.name, region.build);
    }
}

void AddressRegions::take_names(StateReader& state) {
    std::size_t count = 0;
    state(count);
    of_state_.clear();
    for (std::size_t i = 0; i < count; ++i) {
        Named& named = of_state_.emplace_back();
        state(named.name, named.build);
    }
}

std::optional<PortableAddress> AddressRegions::find(std::uint64_t address) const {
    for (std::uint32_t i = 0; i < regions_.size(); ++i) {
        // One past the end of the user data is a place that a pointer may have, too.
        bool const is_inside = address >= regions_[i].begin && address < regions_[i].end;
        if (is_inside || (i == kUserData && address == regions_[i].end && address != regions_[i].begin)) {
            return PortableAddress{.region = i, .offset = address - regions_[i].begin};
        }
    }
    return std::nullopt;
}

std::optional<PortableAddress> AddressRegions::portable(std::uint64_t address) const {
    if (address == 0) {
        return std::nullopt;
    }
    std::optional<PortableAddress> const found = find(address);
    if (!found) {
        refuse("a callback");
    }
    return found;
}

std::uint64_t AddressRegions::address_of(PortableAddress const& place) const {
    if (place.region >= of_state_.size()) {
        throw ForeignState("it names a library that it does not have");
    }
    Named const& named = of_state_[place.region];
    auto const found = std::ranges::find(regions_, named.name, &Region::name);
    if (found == regions_.end() || found->build != named.build || place.offset > found->end - found->begin) {
        throw ForeignState(fmt::format("it has addresses in '{}', which is another one here", named.name));
    }
    return found->begin + place.offset;
}

bool AddressRegions::is_mapped(std::uint64_t address) const {
    auto const after = std::ranges::upper_bound(mapped_, address, {}, &MappedMemory::begin);
    return after != mapped_.begin() && address < (after - 1)->end;
}

/// Addresses of the program and of user data may be at any place (packed structs), others at multiples of their size.
std::vector<FoundAddress> AddressRegions::addresses_in(std::span<std::byte const> bytes,
                                                       std::vector<std::uint64_t>& foreign) const {
    std::vector<FoundAddress> found;
    for (std::size_t at = 0; at + kWord <= bytes.size(); ++at) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, kWord);
        constexpr std::uint64_t least = 0x1000;
        if (word < least || (!found.empty() && at < found.back().at + kWord)) {
            continue;
        }
        std::optional<PortableAddress> const to = find(word);
        bool const is_aligned = at % kWord == 0;
        if (to && (is_aligned || to->region <= kUserData)) {
            found.push_back({.at = at, .to = *to});
        } else if (!to && is_aligned && word >= kLeastForeign && is_mapped(word)) {
            foreign.push_back(at);
        }
    }
    return found;
}

void AddressRegions::take_memory(StateReader& state, std::vector<std::byte>& bytes,
                                 std::vector<FoundAddress>* found) const {
    std::size_t count = 0;
    std::vector<FoundAddress> addresses;
    state(count, addresses);
    std::span const taken = state.take_bytes(count);
    bytes.assign(taken.begin(), taken.end());
    for (FoundAddress const& one : addresses) {
        if (one.at + kWord > bytes.size()) {
            throw ForeignState("it has an address beyond its end");
        }
        std::uint64_t const address = address_of(one.to);
        std::memcpy(bytes.data() + one.at, &address, kWord);
    }
    if (found != nullptr) {
        *found = std::move(addresses);
    }
}

void AddressRegions::refuse(std::string const& what) {
    throw ConfigError(fmt::format("{} has an address in memory that only this process has", what));
}

}  // namespace pogosim
