// The state of a run as bytes: what one process writes, another one of the same build reads. A class lists what it is
// made of once, for both ways:
//
//     template <class Self, class State>
//     static void visit_state(Self& self, State& state) { state(self.count_, self.values_); }
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace pogosim {

/// Bytes that are no state of this run.
class ForeignState : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

namespace state_bytes {

template <class T>
inline constexpr bool is_list = false;
template <class T>
inline constexpr bool is_list<std::vector<T>> = true;
template <>
inline constexpr bool is_list<std::string> = true;

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class T>
inline constexpr bool is_variant = false;
template <class... T>
inline constexpr bool is_variant<std::variant<T...>> = true;

template <class T, class State>
concept Visited = requires(T& value, State& state) {
    std::remove_const_t<T>::visit_state(value, state);
};

/// Stored as it is in memory; a pointer would lead nowhere in another process.
template <class T>
concept Plain = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !is_optional<T> && !is_variant<T>;

}  // namespace state_bytes

class StateWriter {
public:
    static constexpr bool kIsReading = false;

    template <class... T>
    void operator()(T const&... values) {
        (put(values), ...);
    }

    void add_bytes(std::span<std::byte const> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }

    std::vector<std::byte> const& bytes() const { return bytes_; }

private:
    template <class T>
    void put(T const& value) {
        if constexpr (state_bytes::Visited<T const, StateWriter>) {
            T::visit_state(value, *this);
        } else if constexpr (std::is_same_v<T, std::vector<bool>>) {
            put(value.size());
            for (bool const bit : value) {
                put(bit);
            }
        } else if constexpr (state_bytes::is_list<T>) {
            put(value.size());
            if constexpr (state_bytes::Plain<typename T::value_type> &&
                          !state_bytes::Visited<typename T::value_type const, StateWriter>) {
                add_bytes(std::as_bytes(std::span(value)));
            } else {
                for (auto const& element : value) {
                    put(element);
                }
            }
        } else if constexpr (state_bytes::is_optional<T>) {
            put(value.has_value());
            if (value) {
                put(*value);
            }
        } else if constexpr (state_bytes::is_variant<T>) {
            put(value.index());
            std::visit([this](auto const& held) { this->put(held); }, value);
        } else {
            static_assert(state_bytes::Plain<T>);
            add_bytes(std::as_bytes(std::span(&value, 1)));
        }
    }

    std::vector<std::byte> bytes_;
};

class StateReader {
public:
    static constexpr bool kIsReading = true;

    explicit StateReader(std::span<std::byte const> bytes) : rest_(bytes) {}

    /// Throws ForeignState.
    template <class... T>
    void operator()(T&... values) {
        (take(values), ...);
    }

    /// The next bytes. Throws ForeignState if there are not so many.
    std::span<std::byte const> take_bytes(std::size_t count) {
        if (count > rest_.size()) {
            throw ForeignState("it ends too early");
        }
        std::span const taken = rest_.first(count);
        rest_ = rest_.subspan(count);
        return taken;
    }

    std::span<std::byte const>& rest() { return rest_; }

private:
    std::size_t take_size(std::size_t least_bytes_each) {
        std::size_t size = 0;
        take(size);
        if (size > rest_.size() / least_bytes_each) {
            throw ForeignState("it ends too early");
        }
        return size;
    }

    template <class T>
    void take(T& value) {
        if constexpr (state_bytes::Visited<T, StateReader>) {
            T::visit_state(value, *this);
        } else if constexpr (std::is_same_v<T, std::vector<bool>>) {
            value.resize(take_size(1));
            for (std::size_t i = 0; i < value.size(); ++i) {
                bool bit = false;
                take(bit);
                value[i] = bit;
            }
        } else if constexpr (state_bytes::is_list<T>) {
            using Element = typename T::value_type;
            if constexpr (state_bytes::Plain<Element> && !state_bytes::Visited<Element, StateReader>) {
                value.resize(take_size(sizeof(Element)));
                copy_to(value.data(), value.size() * sizeof(Element));
            } else {
                value.resize(take_size(1));
                for (Element& element : value) {
                    take(element);
                }
            }
        } else if constexpr (state_bytes::is_optional<T>) {
            bool has_value = false;
            take(has_value);
            value.reset();
            if (has_value) {
                typename T::value_type inner{};
                take(inner);
                value = std::move(inner);
            }
        } else if constexpr (state_bytes::is_variant<T>) {
            std::size_t index = 0;
            take(index);
            take_alternative(value, index, std::make_index_sequence<std::variant_size_v<T>>());
        } else {
            static_assert(state_bytes::Plain<T>);
            copy_to(&value, sizeof(value));
        }
    }

    template <class Variant, std::size_t... kIndex>
    void take_alternative(Variant& value, std::size_t index, std::index_sequence<kIndex...> /*indices*/) {
        bool const is_known = ((kIndex == index && (take(value.template emplace<kIndex>()), true)) || ...);
        if (!is_known) {
            throw ForeignState("it has a value of an unknown type");
        }
    }

    void copy_to(void* target, std::size_t count) {
        std::span const bytes = take_bytes(count);
        if (count > 0) {
            std::memcpy(target, bytes.data(), count);
        }
    }

    std::span<std::byte const> rest_;
};

}  // namespace pogosim
