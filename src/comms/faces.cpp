#include "comms/faces.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

#include "base/exact_math.hpp"

namespace pogosim {

namespace {

constexpr double kHalfPlaneDeg = 180.0;

float squared_cosine_of_half(float aperture_deg) {
    if (aperture_deg >= kHalfPlaneDeg) {
        return 0.0F;
    }
    double const half_rad = static_cast<double>(aperture_deg) * std::numbers::pi / (2.0 * kHalfPlaneDeg);
    double const cosine = exact::sine_cosine(half_rad).cosine;
    return static_cast<float>(cosine * cosine);
}

/// Whether the cones, if they all began in the centre, leave no gap.
bool look_around(std::vector<Face> const& faces) {
    struct Cone {
        double from;
        double to;
    };
    constexpr double turn = 2.0 * std::numbers::pi;
    constexpr double rounding = 1e-6;
    std::vector<Cone> cones;
    for (Face const& face : faces) {
        double const middle = exact::atan2(face.normal.y, face.normal.x);
        double const half = static_cast<double>(face.reception_deg) * std::numbers::pi / (2.0 * kHalfPlaneDeg);
        for (double const shift : {0.0, turn}) {
            cones.push_back({middle - half + shift, middle + half + shift});
        }
    }
    std::ranges::sort(cones, {}, &Cone::from);
    double end = cones.empty() ? 0.0 : cones.front().to;
    double const all = cones.empty() ? 0.0 : cones.front().from + turn;
    for (Cone const& cone : cones) {
        if (cone.from > end + rounding) {
            break;
        }
        end = std::max(end, cone.to);
    }
    return !cones.empty() && end + rounding >= all;
}

}  // namespace

Faces make_faces(RobotModel const& model, float radius_mm) {
    Faces faces;
    for (std::size_t i = 0; i < model.faces.size(); ++i) {
        Face const& face = model.faces[i];
        Vec2 const place_mm = face.place.at_mm(radius_mm);
        faces.normal_x[i] = face.normal.x;
        faces.normal_y[i] = face.normal.y;
        faces.ahead_mm[i] = dot(face.normal, place_mm);
        faces.aside_mm[i] = cross(face.normal, place_mm);
        faces.emission_cosine2[i] = squared_cosine_of_half(face.emission_deg);
        faces.reception_cosine2[i] = squared_cosine_of_half(face.reception_deg);
        faces.place_mm[i] = place_mm;
        faces.reach_mm = std::max(faces.reach_mm, length(place_mm));
        faces.all |= 1U << i;
    }
    faces.hears_around = look_around(model.faces);
    return faces;
}

std::uint8_t faces_that_see(Faces const& faces, Vec2 emitter_mm, float range_mm, bool in_any_direction) {
    FaceView const view = seen_from(faces, emitter_mm);
    unsigned const seeing =
        bits_of(is_in_cone(view, faces.reception_cosine2) & (view.distance_mm2 <= all_four(range_mm * range_mm))) &
        faces.all;
    if (seeing != 0 || !(faces.hears_around || in_any_direction)) {
        return static_cast<std::uint8_t>(seeing);
    }
    Four const ahead = view.x + faces.ahead_mm;
    unsigned most_ahead = 0;
    for (unsigned face = 1; face < kMostFaces; ++face) {
        bool const is_there = (faces.all >> face & 1U) != 0;
        most_ahead = is_there && ahead[face] > ahead[most_ahead] ? face : most_ahead;
    }
    return static_cast<std::uint8_t>(1U << most_ahead);
}

}  // namespace pogosim
