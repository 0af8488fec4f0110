// Memory of a program as bytes that another process can go on from. Addresses differ from process to process: each word
// that is one is noted by what it leads to, which is in the program, in the user data of robots, or in a library.
//
// What is a word that only looks like an address? Programs and user data lie at places that the system draws anew for
// each process, out of 2^28 or more, and are a few pages long: a number is taken for such an address once in 10^8
// states that contain one of its size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/state_bytes.hpp"
#include "process/loaded_modules.hpp"
#include "process/program_image.hpp"

namespace pogosim {

/// What an address leads to.
struct PortableAddress {
    std::uint32_t region = 0;  // into AddressRegions
    std::uint64_t offset = 0;
};

/// An address in bytes of memory.
struct FoundAddress {
    std::uint64_t at = 0;  // where its first byte is
    PortableAddress to;
};

/// The regions of the address space that have the same content in each process that runs this program.
class AddressRegions {
public:
    AddressRegions(ProgramImage const& image, std::span<std::byte const> user_data);

    /// Takes the regions of the process that wrote the state. Throws ForeignState.
    void append_names(StateWriter& state) const;
    void take_names(StateReader& state);

    /// Absent: it leads to no region.
    std::optional<PortableAddress> find(std::uint64_t address) const;

    /// The address that the state has noted. Throws ForeignState where this process has another library.
    std::uint64_t address_of(PortableAddress const& place) const;

    /// Appends bytes with the addresses in them. `bytes` begin at a multiple of 8 in the program. Throws ConfigError if
    /// they have an address of memory that no other process has; `name_at` says what lies there.
    template <class NameAt>
    void append_memory(StateWriter& state, std::span<std::byte const> bytes, NameAt const& name_at) const {
        std::vector<std::uint64_t> foreign;
        std::vector<FoundAddress> const found = addresses_in(bytes, foreign);
        if (!foreign.empty()) {
            refuse(name_at(foreign.front()));
        }
        state(bytes.size(), found);
        state.add_bytes(bytes);
    }

    /// Takes the bytes of append_memory(), with the addresses of this process. `found`: where they are.
    void take_memory(StateReader& state, std::vector<std::byte>& bytes,
                     std::vector<FoundAddress>* found = nullptr) const;

    template <class Pointer>
    void append_pointer(StateWriter& state, Pointer pointer) const {
        state(portable(reinterpret_cast<std::uint64_t>(pointer)));
    }
    template <class Pointer>
    void take_pointer(StateReader& state, Pointer& pointer) const {
        std::optional<PortableAddress> place;
        state(place);
        // NOLINTNEXTLINE(performance-no-int-to-ptr): it comes from an address
        pointer = place ? reinterpret_cast<Pointer>(address_of(*place)) : nullptr;
    }

private:
    struct Region {
        std::string name;
        std::string build;
        std::uint64_t begin = 0;
        std::uint64_t end = 0;
    };

    [[noreturn]] static void refuse(std::string const& what);
    std::optional<PortableAddress> portable(std::uint64_t address) const;
    std::vector<FoundAddress> addresses_in(std::span<std::byte const> bytes, std::vector<std::uint64_t>& foreign) const;
    bool is_mapped(std::uint64_t address) const;

    std::vector<Region> regions_;       // the program and user data first
    std::vector<MappedMemory> mapped_;  // all memory of this process
    struct Named {
        std::string name;
        std::string build;
    };
    std::vector<Named> of_state_;  // regions of the process that wrote the state
};

}  // namespace pogosim
