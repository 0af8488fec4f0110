// Text composed in a signal handler, without allocating memory, taking locks or using the locale.
#pragma once

#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace pogosim {

/// At most `Size` - 1 characters; what goes beyond is cut.
template <std::size_t Size>
class SignalText {
public:
    SignalText& operator<<(char const* text) {
        for (; *text != '\0' && length_ + 1 < Size; ++text) {
            text_[length_++] = *text;
        }
        text_[length_] = '\0';
        return *this;
    }

    SignalText& whole(std::uint64_t number) { return digits(number, 10); }

    SignalText& address(void const* pointer) {
        *this << "0x";
        return digits(reinterpret_cast<std::uintptr_t>(pointer), 16);
    }

    /// A number from 0 to 1e15 with this many decimals, zeros at its end left out when they are not `kept`.
    SignalText& number(double value, int decimals, bool kept = true) {
        std::uint64_t scale = 1;
        for (int i = 0; i < decimals; ++i) {
            scale *= 10;
        }
        auto scaled = static_cast<std::uint64_t>(value * static_cast<double>(scale) + 0.5);
        for (; !kept && scale > 1 && scaled % 10 == 0; scale /= 10) {
            scaled /= 10;
        }
        whole(scaled / scale);
        if (scale > 1) {
            *this << ".";
            for (std::uint64_t place = scale / 10; place > scaled % scale && place > 1; place /= 10) {
                *this << "0";
            }
            whole(scaled % scale);
        }
        return *this;
    }

    void write_to_stderr() const { [[maybe_unused]] auto const written = write(STDERR_FILENO, text_.data(), length_); }

    char const* c_str() const { return text_.data(); }

private:
    SignalText& digits(std::uint64_t number, unsigned base) {
        std::array<char, 24> reversed{};
        std::size_t count = 0;
        do {
            reversed[count++] = "0123456789abcdef"[number % base];
            number /= base;
        } while (number > 0);
        for (; count > 0 && length_ + 1 < Size; --count) {
            text_[length_++] = reversed[count - 1];
        }
        text_[length_] = '\0';
        return *this;
    }

    std::array<char, Size> text_{};
    std::size_t length_ = 0;
};

}  // namespace pogosim
