#include "config/shape_keys.hpp"

#include <array>

namespace pogosim {

namespace {

using K = Key<Shape>;

constexpr ChoiceRule kAnyCase{.any_case = true};

K solid_geometry_key() {
    return {"geometry",
            one_of(&Shape::kind,
                   {{"disk", ShapeKind::disk}, {"rectangle", ShapeKind::rectangle}, {"triangle", ShapeKind::triangle}},
                   kAnyCase),
            any(), "", "Shape of the object; case-insensitive."};
}

}  // namespace

std::span<K const> robot_geometry_keys() {
    static std::array const keys{solid_geometry_key()};
    return keys;
}

std::span<K const> solid_geometry_keys() {
    static std::array const keys{[] {
        K key = solid_geometry_key();
        key.required = true;
        return key;
    }()};
    return keys;
}

std::span<K const> outline_geometry_keys() {
    static std::array const keys{
        K{"geometry",
          one_of(&Shape::kind,
                 {{"arena", ShapeKind::arena},
                  {"disk", ShapeKind::disk},
                  {"rectangle", ShapeKind::rectangle},
                  {"triangle", ShapeKind::triangle}},
                 kAnyCase),
          any(), "", "arena: all walls; otherwise the outline of a shape at x and y. Case-insensitive.",
          /*required=*/true},
    };
    return keys;
}

std::span<K const> any_geometry_keys() {
    static std::array const keys{
        K{"geometry",
          one_of(&Shape::kind,
                 {{"global", ShapeKind::global},
                  {"arena", ShapeKind::arena},
                  {"disk", ShapeKind::disk},
                  {"rectangle", ShapeKind::rectangle},
                  {"triangle", ShapeKind::triangle}},
                 kAnyCase),
          any(), "",
          "global: everywhere; arena: inside the arena's polygons; otherwise a shape around the centre. "
          "Case-insensitive.",
          /*required=*/true},
    };
    return keys;
}

std::span<K const> size_keys() {
    constexpr auto is_rectangle = [](Shape const& shape) { return shape.kind == ShapeKind::rectangle; };
    static std::array const keys{
        K{"radius", &Shape::radius_mm, kBodyLength, "mm", "Radius of a disk."}.only_if(
            [](Shape const& shape) { return shape.kind == ShapeKind::disk; }),
        K{"body_width", &Shape::width_mm, kBodyLength, "mm", "Size of a rectangle along x."}.only_if(is_rectangle),
        K{"body_height", &Shape::height_mm, kBodyLength, "mm", "Size of a rectangle along y."}.only_if(is_rectangle),
        K{"side_length", &Shape::side_length_mm, kBodyLength, "mm",
          "Side of an equilateral triangle, one corner towards -y."}
            .only_if([](Shape const& shape) { return shape.kind == ShapeKind::triangle; }),
    };
    return keys;
}

}  // namespace pogosim
