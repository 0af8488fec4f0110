// The static objects of programs in C++. Each robot that has variables of its own constructs them itself, as on a real
// robot: an object that owns memory, such as a std::vector, would else share it with its copies.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "pogosim/program.h"

namespace pogosim {

/// What a program's variables were before its static objects were constructed, and what constructs them.
struct Constructors {
    struct Piece {
        std::byte* place;
        std::vector<std::byte> bytes;
    };
    std::vector<Piece> before;
    std::vector<void (*)()> functions;
};

/// Returns the static objects of a program in memory; null: it has none to construct.
std::shared_ptr<Constructors const> constructors_of(pogosim_program const& program);

/// Copies the list of constructors, so that it outlives a program that is unloaded.
void forget_constructors_of(pogosim_program const& program);

/// Makes the variables in these pieces of memory what they were before, and constructs the objects in them.
void construct_again(Constructors const& constructors, std::span<std::span<std::byte> const> pieces);

}  // namespace pogosim
