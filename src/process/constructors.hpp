// The static objects of programs in C++. Each robot that has variables of its own constructs them itself, as on a real
// robot: an object that owns memory, such as a std::vector, would else share it with its copies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pogosim/program.h"

namespace pogosim {

/// An executable or a shared object that is in memory.
struct LoadedObject {
    std::uintptr_t load_address = 0;  // of what its file says
    std::vector<std::span<std::byte>> writable{};
    std::vector<void (*)()> initializers{};  // called before main(), or when it was loaded
    std::vector<void (*)()> finalizers{};    // called at the end of the process, or when it is unloaded
};

/// Functions of the compiler among them, in C as well, which do nothing: the last ones.
#ifdef __linux__
inline constexpr std::size_t kFunctionsOfCompiler = 1;
#else
inline constexpr std::size_t kFunctionsOfCompiler = 0;
#endif

/// The object that contains a place in memory. Empty if that is not known.
LoadedObject loaded_object_at(void const* place);

/// What a program's variables were before its static objects were constructed, and what constructs them.
struct Constructors {
    struct Piece {
        std::byte* place;
        std::vector<std::byte> bytes;
    };
    std::vector<Piece> before;
    std::vector<void (*)()> functions;
};

/// Notes that these functions of a program are about to run.
void note_constructors(pogosim_program const& program, LoadedObject const& object, std::vector<void (*)()> functions);

/// Returns the static objects of a program in memory; null: it has none to construct.
std::shared_ptr<Constructors const> constructors_of(pogosim_program const& program);

/// Forgets what was noted of a program.
void forget_constructors_of(pogosim_program const& program);

/// Makes the variables in these pieces of memory what they were before, and constructs the objects in them.
void construct_again(Constructors const& constructors, std::span<std::span<std::byte> const> pieces);

}  // namespace pogosim
