#include "base/state_bytes.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace pogosim {
namespace {

struct Inner {
    std::string name;
    std::vector<std::uint16_t> numbers;

    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.name, self.numbers);
    }
    friend bool operator==(Inner const&, Inner const&) = default;
};

struct Outer {
    double value = 0.0;
    std::vector<Inner> inner;
    std::optional<std::string> other;
    std::variant<std::monostate, std::int32_t, std::string> cell;
    std::vector<bool> bits;

    template <class Self, class State>
    static void visit_state(Self& self, State& state) {
        state(self.value, self.inner, self.other, self.cell, self.bits);
    }
    friend bool operator==(Outer const&, Outer const&) = default;
};

std::vector<std::byte> bytes_of(Outer const& outer) {
    StateWriter state;
    state(outer);
    return state.bytes();
}

/// Not inlined: gcc 12 would warn of the text of an optional that it takes for uninitialized.
[[gnu::noinline]] void take(StateReader& state, Outer& into) {
    state(into);
}

Outer const kFull{.value = -0.5,
                  .inner = {{.name = "a", .numbers = {1, 2, 65535}}, {}},
                  .other = std::string(300, 'x'),
                  .cell = "text",
                  .bits = {true, false, true}};

TEST(StateBytes, GiveTheSameValuesAgain) {
    for (Outer const& outer : {kFull, Outer{}}) {
        std::vector<std::byte> const bytes = bytes_of(outer);
        StateReader state(bytes);
        Outer read = kFull;
        take(state, read);
        EXPECT_EQ(read, outer);
        EXPECT_TRUE(state.rest().empty());
    }
}

TEST(StateBytes, ThatAreCutOffAnywhereAreForeign) {
    std::vector<std::byte> const bytes = bytes_of(kFull);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        StateReader state(std::span<std::byte const>(bytes).first(size));
        Outer read;
        EXPECT_THROW(take(state, read), ForeignState) << size;
    }
}

TEST(StateBytes, OfMoreElementsThanThereAreBytesTakeNoMemory) {
    StateWriter writer;
    writer(std::size_t{1} << 60U);
    StateReader state(writer.bytes());
    std::vector<double> numbers;
    EXPECT_THROW(state(numbers), ForeignState);
    EXPECT_EQ(numbers.capacity(), 0U);
}

}  // namespace
}  // namespace pogosim
