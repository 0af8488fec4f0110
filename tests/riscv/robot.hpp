// A processor with a memory and a program, for tests.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "riscv/assembler.hpp"
#include "riscv/core.hpp"

namespace pogosim::testing {

struct Robot {
    std::shared_ptr<MemoryImage const> image;
    std::shared_ptr<Code const> code;
    Memory memory;
    Core core;

    /// Words are at address 0, in a memory of so many bytes.
    explicit Robot(std::vector<std::uint32_t> const& words, CycleCosts const& costs = {},
                   std::size_t memory_bytes = kMemoryBytes)
        : image(image_of(words, memory_bytes)),
          code(std::make_shared<Code const>(decode_code(0, std::span(image->bytes).first(4 * words.size()), costs))),
          memory(image) {}

    Stop run(std::uint64_t most_cycles = 1'000'000) { return pogosim::run(core, memory, *code, most_cycles); }

private:
    static std::shared_ptr<MemoryImage const> image_of(std::vector<std::uint32_t> const& words, std::size_t bytes) {
        MemoryImage image;
        image.bytes.resize(bytes);
        std::ranges::copy(bytes_of(words), image.bytes.begin());
        return std::make_shared<MemoryImage const>(std::move(image));
    }
};

/// A cycle for each instruction, all in the cache.
inline constexpr CycleCosts kOneCycleEach{1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};

}  // namespace pogosim::testing
