#include "process/constructors.hpp"

#include <map>
#include <mutex>
#include <utility>

#include "process/program_memory.hpp"

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

void note_constructors(pogosim_program const& program, LoadedObject const& object, std::vector<void (*)()> functions) {
    if (functions.size() <= kFunctionsOfCompiler) {
        return;
    }
    Constructors constructors{.before = {}, .functions = std::move(functions)};
    for (std::span<std::byte> const piece : object.writable) {
        Constructors::Piece kept{.place = piece.data(), .bytes = std::vector<std::byte>(piece.size())};
        copy_program_bytes(kept.bytes.data(), kept.place, kept.bytes.size());
        constructors.before.push_back(std::move(kept));
    }
    std::lock_guard const lock(noted().mutex);
    noted().of_program[&program] = std::make_shared<Constructors const>(std::move(constructors));
}

}  // namespace pogosim
