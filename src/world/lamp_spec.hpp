// A lamp as a configuration describes it, whatever its kind. Each kind has a struct of its own, which the files of
// src/lamps define; here is what all have in common.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "geometry/arena.hpp"
#include "geometry/shape.hpp"

namespace pogosim {

class Lamp;  // light/lamp.hpp
struct LightMap;

/// A level times an intensity, within 15 bits.
inline int scaled_level(int level, float intensity) {
    constexpr auto brightest = static_cast<float>(std::numeric_limits<std::int16_t>::max());
    return static_cast<int>(std::lround(std::clamp(static_cast<float>(level) * intensity, 0.0F, brightest)));
}

/// The parameters of a kind of lamp, with `==`. `make_lamp(spec, arena, map)` makes a lamp of them.
template <class T>
concept LampParameters = requires(T& spec, T const& fixed, float intensity) {
    { spec.shape } -> std::same_as<Shape&>;             // of the area that it can light
    { spec.centre_mm } -> std::same_as<Vec2&>;          // where it stands, or the centre of its orbit
    { T::kAddsUp } -> std::convertible_to<bool>;        // its light adds to that of others, or replaces it
    { fixed.start_mm() } -> std::same_as<Vec2>;         // where its area is at time 0
    { fixed.brightest() } -> std::convertible_to<int>;  // its highest level, sensor counts
    { spec.scale_levels(intensity) } -> std::same_as<void>;
};

/// The parameters of a lamp of any kind. A value: copies are independent and compare equal.
class LampSpec {
public:
    template <LampParameters T>
    LampSpec(T spec) : kind_(std::make_shared<Of<T> const>(std::move(spec))) {}

    Shape const& shape() const { return kind_->shape(); }
    Vec2 centre_mm() const { return kind_->centre_mm(); }
    Vec2 start_mm() const { return kind_->start_mm(); }
    bool adds_up() const { return kind_->adds_up(); }
    int brightest() const { return kind_->brightest(); }

    /// The parameters if the lamp is of this kind, else nullptr.
    template <LampParameters T>
    T const* get_if() const {
        auto const* const found = dynamic_cast<Of<T> const*>(kind_.get());
        return found == nullptr ? nullptr : &found->spec;
    }

    /// The lamp at work, moved, and with its levels times an intensity. `map` gives the cells.
    std::shared_ptr<Lamp const> make(Vec2 moved_mm, float intensity, Arena const& arena, LightMap const& map) const {
        return kind_->make(moved_mm, intensity, arena, map);
    }

    bool casts_shadows = false;  // walls and bodies hide it

    friend bool operator==(LampSpec const& a, LampSpec const& b) {
        return a.casts_shadows == b.casts_shadows && a.kind_->equals(*b.kind_);
    }

private:
    struct Kind {
        virtual ~Kind() = default;
        virtual Shape const& shape() const = 0;
        virtual Vec2 centre_mm() const = 0;
        virtual Vec2 start_mm() const = 0;
        virtual bool adds_up() const = 0;
        virtual int brightest() const = 0;
        virtual std::shared_ptr<Lamp const> make(Vec2 moved_mm, float intensity, Arena const& arena,
                                                 LightMap const& map) const = 0;
        virtual bool equals(Kind const& other) const = 0;
    };

    template <LampParameters T>
    struct Of final : Kind {
        explicit Of(T of) : spec(std::move(of)) {}

        Shape const& shape() const override { return spec.shape; }
        Vec2 centre_mm() const override { return spec.centre_mm; }
        Vec2 start_mm() const override { return spec.start_mm(); }
        bool adds_up() const override { return T::kAddsUp; }
        int brightest() const override { return spec.brightest(); }
        std::shared_ptr<Lamp const> make(Vec2 moved_mm, float intensity, Arena const& arena,
                                         LightMap const& map) const override {
            T changed = spec;
            changed.centre_mm = changed.centre_mm + moved_mm;
            if (intensity != 1.0F) {
                changed.scale_levels(intensity);
            }
            return make_lamp(changed, arena, map);
        }
        bool equals(Kind const& other) const override {
            auto const* const same_kind = dynamic_cast<Of const*>(&other);
            return same_kind != nullptr && spec == same_kind->spec;
        }

        T spec;
    };

    std::shared_ptr<Kind const> kind_;
};

/// A lamp with a place.
struct LampMark {
    Vec2 centre_mm;         // where it stands
    Shape shape{};          // the area that it can light; global and arena: no outline
    Vec2 shape_mm{};        // where the shape's centre is; alternating rays stand at its corners
    bool has_beam = false;  // a lighthouse
    float beam_rad = 0.0F;  // direction of its beam, if it is on
    bool beam_is_on = false;
};

}  // namespace pogosim
