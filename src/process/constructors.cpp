#include "process/constructors.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>

#include "process/loaded_object.hpp"
#include "process/program_bytes.hpp"

namespace pogosim {

namespace {

// One entry for each program. Allocated on first use, which may come before the static objects of this library are
// constructed.
struct Noted {
    std::mutex mutex;
    std::map<pogosim_program const*, std::shared_ptr<Constructors const>> of_program;
};
Noted& noted() {
    static auto* const all = new Noted();  // programs may be loaded until the process ends
    return *all;
}

}  // namespace

std::shared_ptr<Constructors const> constructors_of(pogosim_program const& program) {
    std::lock_guard const lock(noted().mutex);
    auto const place = noted().of_program.find(&program);
    return place == noted().of_program.end() ? nullptr : place->second;
}

void forget_constructors_of(pogosim_program const& program) {
    std::lock_guard const lock(noted().mutex);
    noted().of_program.erase(&program);
}

void construct_again(Constructors const& constructors, std::span<std::span<std::byte> const> pieces) {
    for (Constructors::Piece const& piece : constructors.before) {
        for (std::span<std::byte> const variables : pieces) {
            if (variables.data() >= piece.place && variables.data() < piece.place + piece.bytes.size()) {
                copy_program_bytes(variables.data(), piece.bytes.data() + (variables.data() - piece.place),
                                   variables.size());
            }
        }
    }
    for (void (*const construct)() : constructors.functions) {
        construct();
    }
}

}  // namespace pogosim

void pogosim_before_constructors(pogosim_program const* program, void (*self)()) {
    using namespace pogosim;
    constexpr std::size_t kCompilersOwn = 1;  // the last one, in C as well, which does nothing
    forget_constructors_of(*program);         // of one that was there before it, and did not fit
    LoadedObject const object = loaded_object_at(program);
    auto const first = std::ranges::find(object.initializers, self);
    std::vector<void (*)()> after;
    if (first != object.initializers.end()) {
        after.assign(first + 1, object.initializers.end());
    }
    if (after.size() <= kCompilersOwn) {
        return;
    }
    Constructors constructors{.before = {}, .functions = std::move(after)};
    for (std::span<std::byte> const piece : object.writable) {
        Constructors::Piece kept{.place = piece.data(), .bytes = std::vector<std::byte>(piece.size())};
        copy_program_bytes(kept.bytes.data(), kept.place, kept.bytes.size());
        constructors.before.push_back(std::move(kept));
    }
    std::lock_guard const lock(noted().mutex);
    noted().of_program[program] = std::make_shared<Constructors const>(std::move(constructors));
}
