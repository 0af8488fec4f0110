#include "geometry/formation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace pogosim {
namespace {

namespace fs = std::filesystem;

constexpr float kRobotRadius = 26.5F;
constexpr float kTolerance = 0.01F;  // mm
constexpr float kPi = std::numbers::pi_v<float>;

std::vector<std::string> const kShipped = [] {
    std::vector<std::string> names;
    for (auto const& entry : fs::directory_iterator(fs::path(POGOSIM_SOURCE_DIR) / "arenas")) {
        names.push_back(entry.path().stem().string());
    }
    std::erase_if(names, [](std::string const& name) { return name == "empty" || name == "torus"; });
    std::ranges::sort(names);
    return names;
}();

Arena shipped(std::string const& name, double surface_mm2 = 1.0e6) {
    return scale_arena(read_arena_file(fs::path(POGOSIM_SOURCE_DIR) / "arenas" / (name + ".csv")),
                       {surface_mm2, false});
}

/// All formations that compute the places themselves.
std::vector<std::string> computed_formations() {
    std::vector<std::string> names(formation_names().begin(), formation_names().end());
    std::erase(names, "imported");
    return names;
}

std::vector<float> robots(std::size_t count) {
    return std::vector<float>(count, kRobotRadius);
}

std::vector<Placement> place_seeded(FormationSpec const& spec, std::span<float const> radii, Arena const& arena,
                                    std::uint64_t seed) {
    RandomStream random(seed, 5);
    return place(spec, radii, {arena}, random);
}

FormationSpec named(std::string const& name) {
    FormationSpec spec;
    spec.name = name;
    return spec;
}

bool operator==(Placement const& a, Placement const& b) {
    return a.position_mm == b.position_mm && a.heading_rad == b.heading_rad;
}

std::string error_of(FormationSpec const& spec, std::span<float const> radii, Arena const& arena) {
    try {
        place_seeded(spec, radii, arena, 1);
    } catch (ConfigError const& error) {
        return error.what();
    }
    return "";
}

/// Every object inside, off the walls, clear of the others, with a heading in (-pi, pi].
void expect_legal(std::vector<Placement> const& placements, std::span<float const> radii, Arena const& arena,
                  std::string const& what) {
    ASSERT_EQ(placements.size(), radii.size()) << what;
    for (std::size_t i = 0; i < placements.size(); ++i) {
        Vec2 const place = placements[i].position_mm;
        ASSERT_TRUE(arena.contains(place)) << what << ", object " << i;
        ASSERT_GE(arena.distance_to_walls(place), radii[i] - kTolerance) << what << ", object " << i;
        for (std::size_t j = 0; j < i; ++j) {
            ASSERT_GE(length(place - placements[j].position_mm), radii[i] + radii[j] - kTolerance)
                << what << ", objects " << i << " and " << j;
        }
        ASSERT_GT(placements[i].heading_rad, -kPi) << what;
        ASSERT_LE(placements[i].heading_rad, kPi) << what;
    }
}

/// Formations whose positions are drawn at random.
bool is_random(std::string const& name) {
    return name.find("random") != std::string::npos || name.find("lloyd") != std::string::npos;
}

class EveryFormation : public testing::TestWithParam<std::string> {};

TEST_P(EveryFormation, StandsLegallyInEveryArena) {
    for (std::string const& arena_name : kShipped) {
        Arena const arena = shipped(arena_name);
        for (std::size_t const count : {1, 2, 25, 100}) {
            FormationSpec spec = named(GetParam());
            spec.chessboard_pitch_mm = 60.0F;
            // Seeds differ between counts and most arenas.
            std::uint64_t const seed = 1000 * count + arena_name.size();
            std::string const what = GetParam() + " in " + arena_name + ", " + std::to_string(count);
            expect_legal(place_seeded(spec, robots(count), arena, seed), robots(count), arena, what);
        }
    }
}

TEST_P(EveryFormation, ThreeHundredRobotsStandLegallyOrAreRefusedWithAdvice) {
    for (std::string const& arena_name : kShipped) {
        Arena const arena = shipped(arena_name);
        FormationSpec spec = named(GetParam());
        spec.chessboard_pitch_mm = 54.0F;
        try {
            expect_legal(place_seeded(spec, robots(300), arena, 3), robots(300), arena,
                         GetParam() + " in " + arena_name);
        } catch (ConfigError const& error) {
            std::string const message = error.what();
            EXPECT_FALSE(GetParam().ends_with("lloyd")) << arena_name << ": " << message;
            EXPECT_TRUE(message.starts_with("initial_formation: '" + GetParam() + "'")) << message;
            EXPECT_NE(message.find("300 objects (largest radius 26.5 mm)"), std::string::npos) << message;
            EXPECT_NE(message.find("reduce nb"), std::string::npos) << message;
        }
    }
}

TEST_P(EveryFormation, EqualSeedsGiveEqualPosesAndOthersDoNot) {
    for (std::string const arena_name : {"disk", "annulus", "star"}) {
        Arena const arena = shipped(arena_name);
        FormationSpec const spec = named(GetParam());
        auto const first = place_seeded(spec, robots(20), arena, 1);
        auto const again = place_seeded(spec, robots(20), arena, 1);
        auto const other = place_seeded(spec, robots(20), arena, 2);
        EXPECT_TRUE(std::ranges::equal(first, again, [](auto& a, auto& b) { return a == b; }));
        for (std::size_t i = 0; i < first.size(); ++i) {
            EXPECT_EQ(first[i].position_mm == other[i].position_mm, !is_random(GetParam())) << i;
        }
    }
}

TEST_P(EveryFormation, ObjectsOfManySizesStandLegally) {
    std::vector<float> radii = robots(40);
    radii[7] = 110.0F;
    radii[20] = 90.0F;
    radii[3] = 5.0F;
    radii[4] = 0.5F;
    for (std::string const arena_name : {"disk", "square", "H", "arena9"}) {
        // Neighbours of a lattice are as far apart as its two largest objects would be.
        Arena const arena = shipped(arena_name, is_lattice(GetParam()) ? 8.0e6 : 2.0e6);
        expect_legal(place_seeded(named(GetParam()), radii, arena, 1), radii, arena, GetParam() + " in " + arena_name);
    }
}

TEST_P(EveryFormation, SmallestSpaceKeepsCentresTwiceThatApart) {
    FormationSpec spec = named(GetParam());
    spec.min_space_mm = 45.0F;
    auto const placements = place_seeded(spec, robots(30), shipped("disk"), 1);
    for (std::size_t i = 0; i < placements.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_GE(length(placements[i].position_mm - placements[j].position_mm), 2.0F * 1.01F * 45.0F - kTolerance);
        }
    }
}

TEST_P(EveryFormation, NoObjectsNeedNoPlace) {
    EXPECT_TRUE(place_seeded(named(GetParam()), {}, shipped("disk"), 1).empty());
}

TEST_P(EveryFormation, ObjectsWithoutASizeStandInsideToo) {
    std::vector<float> const points(30, 0.0F);
    for (std::string const arena_name : {"square", "annulus"}) {
        Arena const arena = shipped(arena_name);
        expect_legal(place_seeded(named(GetParam()), points, arena, 1), points, arena,
                     GetParam() + " in " + arena_name);
    }
}

TEST_P(EveryFormation, OneObjectLargerThanTheArenaIsRefused) {
    std::vector<float> const giant{600.0F};
    EXPECT_NE(error_of(named(GetParam()), giant, shipped("disk")), "");
    std::vector<float> const too_wide_for_the_ring{140.0F};
    EXPECT_NE(error_of(named(GetParam()), too_wide_for_the_ring, shipped("annulus")), "");
}

TEST_P(EveryFormation, HopelessRequestsEndInAnError) {
    // Robots that cover 86 % of the arena: less than the densest packing, more than any of these reach.
    EXPECT_NE(error_of(named(GetParam()), robots(1000), shipped("H", 2.6e6)), "");
}

TEST_P(EveryFormation, ArenaMayBeAnywhereInThePlane) {
    Polygon far = shipped("disk").outer();
    for (Vec2& corner : far) {
        corner = corner + Vec2{-5000.0F, 3000.0F};
    }
    Arena const arena = make_arena({far});
    expect_legal(place_seeded(named(GetParam()), robots(30), arena, 1), robots(30), arena, GetParam());
}

TEST_P(EveryFormation, AlignedOnesFaceDownAndOthersAnywhere) {
    FormationSpec const spec = named(GetParam());
    auto const placements = place_seeded(spec, robots(80), shipped("square", 4.0e6), 1);
    std::complex<double> sum;
    for (Placement const& placement : placements) {
        sum += std::polar(1.0, static_cast<double>(placement.heading_rad));
    }
    if (GetParam().starts_with("aligned")) {
        for (Placement const& placement : placements) {
            EXPECT_FLOAT_EQ(placement.heading_rad, 0.5F * kPi);
        }
    } else {
        // Rayleigh: for uniform headings, 2 |sum|^2 / n is chi-squared with 2 degrees of freedom; 18.4 has p = 1e-4.
        EXPECT_LT(2.0 * std::norm(sum) / 80.0, 18.4);
    }
}

INSTANTIATE_TEST_SUITE_P(Formation, EveryFormation, testing::ValuesIn(computed_formations()),
                         [](auto const& info) { return info.param; });

TEST(Formation, UnknownNameIsRefusedNamingTheNearestKnownOne) {
    EXPECT_EQ(error_of(named("power_loyd"), robots(1), shipped("disk")),
              "initial_formation: unknown formation 'power_loyd'. Did you mean 'power_lloyd'?");
    EXPECT_NE(error_of(named("zzz"), robots(1), shipped("disk")).find("Known: random, aligned_random"),
              std::string::npos);
    EXPECT_NE(error_of(named(""), robots(1), shipped("disk")), "");
}

TEST(Formation, ValuesThatMakeNoSenseAreRefusedWithTheirKey) {
    Arena const arena = shipped("disk");
    float const nan = std::numeric_limits<float>::quiet_NaN();
    float const inf = std::numeric_limits<float>::infinity();
    for (float const bad : {-1.0F, nan, inf}) {
        FormationSpec spec;
        spec.min_space_mm = bad;
        EXPECT_TRUE(error_of(spec, robots(1), arena).starts_with("formation_min_space_between_neighbors: ")) << bad;
    }
    for (float const bad : {-1.0F, 0.0F, nan}) {
        FormationSpec spec;
        spec.max_space_mm = bad;
        EXPECT_TRUE(error_of(spec, robots(1), arena).starts_with("formation_max_space_between_neighbors: ")) << bad;
    }
    for (float const bad : {-1.0F, 0.0F, nan, inf}) {
        FormationSpec spec;
        spec.chessboard_pitch_mm = bad;
        EXPECT_TRUE(error_of(spec, robots(1), arena).starts_with("chessboard_distance_between_neighbors: ")) << bad;
    }
    for (float const bad : {-1.0F, 0.0F, nan, inf}) {
        FormationSpec spec;
        spec.lattice_spacing_mm = bad;
        EXPECT_TRUE(error_of(spec, robots(1), arena).starts_with("lattice_distance_between_neighbors: ")) << bad;
    }
    FormationSpec no_attempts;
    no_attempts.attempts_per_point = 0;
    EXPECT_TRUE(error_of(no_attempts, robots(1), arena).starts_with("formation_attempts_per_point: "));
    FormationSpec negative_restarts;
    negative_restarts.max_restarts = -1;
    EXPECT_TRUE(error_of(negative_restarts, robots(1), arena).starts_with("formation_max_restarts: "));
}

TEST(Formation, CentreOutsideTheArenaIsRefused) {
    for (float const far : {-1.0F, 1.0e9F, std::numeric_limits<float>::infinity()}) {
        for (char const* const name : {"disk", "chessboard"}) {
            FormationSpec spec = named(name);
            spec.centre_mm = {far, 500.0F};
            EXPECT_TRUE(error_of(spec, robots(1), shipped("disk")).starts_with("initial_formation_center: ")) << far;
        }
    }
}

TEST(RandomFormation, IsUniformOverADisk) {
    // Small objects, far apart on average: the walls take a ring of 1.1 * 1.01 mm only, and overlaps hardly matter.
    Arena const arena = shipped("disk");
    std::vector<float> const small(4000, 1.0F);
    auto const placements = place_seeded(named("random"), small, arena, 9);
    Vec2 const centre = arena.bounds.centre();
    float const reach = 0.5F * arena.bounds.size().x - 1.111F;
    // Squared distance over squared reach is uniform in [0, 1], and so is the direction: chi-squared over 10 x 10
    // cells.
    std::vector<int> cells(100);
    for (Placement const& placement : placements) {
        Vec2 const offset = placement.position_mm - centre;
        auto const ring = std::min(static_cast<int>(10.0F * squared_length(offset) / (reach * reach)), 9);
        auto const sector =
            std::min(static_cast<int>(10.0F * (std::atan2(offset.y, offset.x) + kPi) / (2.0F * kPi)), 9);
        ++cells[static_cast<std::size_t>(10 * ring + sector)];
    }
    double chi_squared = 0.0;
    for (int const count : cells) {
        chi_squared += (count - 40.0) * (count - 40.0) / 40.0;
    }
    EXPECT_LT(chi_squared, 161.3);  // p = 1e-4 at 99 degrees of freedom
    EXPECT_GT(chi_squared, 53.0);   // nor more even than chance
}

TEST(RandomFormation, KeepsElevenTenthsOfThePlacementRadiusFromWalls) {
    Arena const arena = shipped("H");
    for (Placement const& placement : place_seeded(named("random"), robots(100), arena, 1)) {
        EXPECT_GE(arena.distance_to_walls(placement.position_mm), 1.1F * 1.01F * kRobotRadius - kTolerance);
    }
}

TEST(RandomFormation, LargestSpaceKeepsEveryObjectNearAnother) {
    FormationSpec spec = named("random");
    spec.max_space_mm = 60.0F;
    for (std::uint64_t const seed : {1, 2, 3}) {
        auto const placements = place_seeded(spec, robots(50), shipped("disk", 4.0e6), seed);
        expect_legal(placements, robots(50), shipped("disk", 4.0e6), "random with max_space");
        for (std::size_t i = 0; i < placements.size(); ++i) {
            float nearest = std::numeric_limits<float>::infinity();
            for (std::size_t j = 0; j < placements.size(); ++j) {
                nearest =
                    i == j ? nearest : std::min(nearest, length(placements[i].position_mm - placements[j].position_mm));
            }
            EXPECT_LE(nearest, 60.0F + kTolerance);
        }
    }
}

TEST(RandomFormation, LargestSpaceBelowContactIsRefused) {
    FormationSpec spec = named("random");
    spec.max_space_mm = 50.0F;
    EXPECT_TRUE(error_of(spec, robots(5), shipped("disk")).starts_with("formation_max_space_between_neighbors: "));
}

TEST(RandomFormation, TooManyRobotsAreRefusedWithCountsAndAdvice) {
    std::string const message = error_of(named("random"), robots(40), shipped("disk", 130000.0));
    EXPECT_TRUE(message.starts_with("initial_formation: 'random' could place only ")) << message;
    EXPECT_TRUE(
        message.ends_with(" of 40 objects (largest radius 26.5 mm) in this arena after 100 restarts; reduce nb, "
                          "enlarge arena_surface, or use power_lloyd"))
        << message;
}

TEST(RandomFormation, MoreThanTheWholeAreaIsRefusedAtOnce) {
    EXPECT_NE(error_of(named("random"), robots(1000), shipped("disk")).find("they need 22505"), std::string::npos);
}

TEST(NearWallsFormation, FewRobotsStandOneAndAHalfRadiiFromAWall) {
    for (char const* const name : {"square", "annulus", "star", "arena8"}) {
        Arena const arena = shipped(name);
        for (Placement const& placement : place_seeded(named("random_near_walls"), robots(15), arena, 1)) {
            EXPECT_LE(arena.distance_to_walls(placement.position_mm), 1.5F * 1.01F * kRobotRadius + kTolerance) << name;
        }
    }
}

TEST(NearWallsFormation, ManyRobotsFormLayersInContact) {
    Arena const arena = shipped("square");
    auto const placements = place_seeded(named("random_near_walls"), robots(150), arena, 1);
    int in_layers = 0;
    for (Placement const& placement : placements) {
        if (arena.distance_to_walls(placement.position_mm) > 1.6F * kRobotRadius) {
            ++in_layers;
            EXPECT_TRUE(std::ranges::any_of(placements, [&](Placement const& other) {
                float const distance = length(other.position_mm - placement.position_mm);
                return distance > 0.0F && distance < 2.03F * kRobotRadius;
            }));
        }
    }
    EXPECT_GT(in_layers, 50);
}

TEST(DiskFormation, FirstRobotStandsAtTheCentreAndSixAroundIt) {
    Arena const arena = shipped("square");
    auto const placements = place_seeded(named("disk"), robots(7), arena, 1);
    EXPECT_NEAR(length(placements[0].position_mm - Vec2{500, 500}), 0.0F, kTolerance);
    for (std::size_t i = 1; i < 7; ++i) {
        EXPECT_NEAR(length(placements[i].position_mm - placements[0].position_mm), 2.02F * kRobotRadius, 0.1F);
    }
}

TEST(DiskFormation, IsCompact) {
    Arena const arena = shipped("square");
    for (std::size_t const count : {10, 50, 150, 250}) {
        auto const placements = place_seeded(named("disk"), robots(count), arena, 1);
        // A disk that is covered to 60 % and a rim of one robot.
        float const reach = kRobotRadius * (std::sqrt(static_cast<float>(count) / 0.6F) + 1.0F);
        for (Placement const& placement : placements) {
            EXPECT_LT(length(placement.position_mm - arena.bounds.centre()), reach) << count;
        }
    }
}

TEST(DiskFormation, StandsAroundTheCentreAskedFor) {
    FormationSpec spec = named("disk");
    spec.centre_mm = {200.0F, 700.0F};
    EXPECT_NEAR(length(place_seeded(spec, robots(7), shipped("square"), 1)[0].position_mm - spec.centre_mm), 0.0F,
                kTolerance);
    spec.centre_mm.y = std::numeric_limits<float>::quiet_NaN();
    Vec2 const half_given = place_seeded(spec, robots(7), shipped("square"), 1)[0].position_mm;
    EXPECT_NEAR(length(half_given - Vec2{200.0F, 500.0F}), 0.0F, kTolerance);
}

TEST(DiskFormation, SurroundsAHoleAtItsCentre) {
    Arena const arena = shipped("annulus");
    for (Placement const& placement : place_seeded(named("disk"), robots(30), arena, 1)) {
        EXPECT_LT(length(placement.position_mm - arena.bounds.centre()), 495.0F + 4.0F * kRobotRadius);
    }
}

TEST(ChessboardFormation, NodesAreOnePitchApartAroundTheCentre) {
    Arena const arena = shipped("square");
    auto const placements = place_seeded(named("chessboard"), robots(49), arena, 1);
    for (Placement const& placement : placements) {
        Vec2 const node = 0.01F * (placement.position_mm - Vec2{500, 500});
        EXPECT_NEAR(node.x, std::round(node.x), 1.0e-4F);
        EXPECT_NEAR(node.y, std::round(node.y), 1.0e-4F);
        EXPECT_LE(std::max(std::abs(node.x), std::abs(node.y)), 3.001F);
    }
    EXPECT_NEAR(length(placements[0].position_mm - Vec2{500, 500}), 0.0F, kTolerance);
    for (std::size_t i = 1; i < 5; ++i) {
        EXPECT_NEAR(length(placements[i].position_mm - Vec2{500, 500}), 100.0F, kTolerance);
    }
}

TEST(ChessboardFormation, SpreadGridHasAsManyNodesAsObjectsWhenItCan) {
    FormationSpec spec = named("chessboard");
    spec.cluster_at_centre = false;
    spec.chessboard_pitch_mm = 115.0F;
    Arena const arena = shipped("square");
    auto const placements = place_seeded(spec, robots(64), arena, 1);
    // 8 x 8 nodes: the pitch is within 8 % of the one asked for, and the grid is centred.
    float const pitch = placements[1].position_mm.x - placements[0].position_mm.x;
    EXPECT_NEAR(pitch, 115.0F, 0.08F * 115.0F);
    for (std::size_t i = 0; i < 64; ++i) {
        Vec2 const offset = placements[i].position_mm - Vec2{500, 500};
        EXPECT_NEAR(offset.x, (static_cast<float>(i % 8) - 3.5F) * pitch, kTolerance);
        EXPECT_NEAR(offset.y, (static_cast<float>(i / 8) - 3.5F) * pitch, kTolerance);
    }
}

TEST(ChessboardFormation, SpreadGridIsThinnedEvenlyOtherwise) {
    FormationSpec spec = named("chessboard");
    spec.cluster_at_centre = false;
    for (std::string const& arena_name : kShipped) {
        Arena const arena = shipped(arena_name);
        auto const placements = place_seeded(spec, robots(41), arena, 1);
        expect_legal(placements, robots(41), arena, "spread chessboard in " + arena_name);
        Vec2 mean;
        for (Placement const& placement : placements) {
            mean = mean + (1.0F / 41.0F) * placement.position_mm;
        }
        EXPECT_LT(std::abs(mean.y - arena.bounds.centre().y), 0.25F * arena.bounds.size().y) << arena_name;
    }
}

TEST(ChessboardFormation, PitchBelowTheDiameterIsRefused) {
    for (bool const cluster : {true, false}) {
        FormationSpec spec = named("chessboard");
        spec.cluster_at_centre = cluster;
        spec.chessboard_pitch_mm = 50.0F;
        EXPECT_NE(error_of(spec, robots(4), shipped("square")).find("must be at least 53.53 mm"), std::string::npos);
        spec.chessboard_pitch_mm = 0.001F;
        EXPECT_NE(error_of(spec, std::vector<float>(4, 0.0F), shipped("square")).find("more than 1000000 places"),
                  std::string::npos);
    }
}

TEST(ChessboardFormation, TooManyForTheGridAreRefusedWithTheNumberOfPlaces) {
    FormationSpec spec = named("chessboard");
    EXPECT_NE(error_of(spec, robots(100), shipped("square")).find("room for only 81 of 100"), std::string::npos);
    spec.cluster_at_centre = false;
    EXPECT_NE(error_of(spec, robots(122), shipped("square")).find("at most 121 places"), std::string::npos);
}

FormationSpec lattice(LatticeKind kind) {
    FormationSpec spec = named("lattice");
    spec.lattice_kind = kind;
    return spec;
}

/// Pairs of objects at this distance; none are nearer.
std::size_t pairs_apart(std::vector<Placement> const& placements, float spacing_mm) {
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < placements.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            float const apart_mm = length(placements[i].position_mm - placements[j].position_mm);
            EXPECT_GT(apart_mm, spacing_mm - kTolerance);
            pairs += apart_mm < spacing_mm + kTolerance ? 1 : 0;
        }
    }
    return pairs;
}

Box box_around(std::vector<Placement> const& placements) {
    Polygon places;
    std::ranges::transform(placements, std::back_inserter(places), &Placement::position_mm);
    return bounding_box(places);
}

TEST(LatticeFormation, HasAsManyPairsOfNeighboursAsThatManyNodesCanHave) {
    // F. Harary and H. Harborth, "Extremal animals", 1976.
    Arena const arena = shipped("square", 4.0e6);
    float const spacing_mm = lattice_spacing_of(named("lattice"), robots(1));
    EXPECT_NEAR(spacing_mm, 2.02F * kRobotRadius, 0.1F);
    for (std::size_t count = 1; count <= 130; ++count) {
        auto const n = static_cast<double>(count);
        auto const most_triangular = static_cast<std::size_t>(3.0 * n - std::ceil(std::sqrt(12.0 * n - 3.0)));
        auto const most_square = static_cast<std::size_t>(2.0 * n - std::ceil(2.0 * std::sqrt(n)));
        auto const triangular = place_seeded(lattice(LatticeKind::triangular), robots(count), arena, 1);
        auto const square = place_seeded(lattice(LatticeKind::square), robots(count), arena, 1);
        EXPECT_EQ(pairs_apart(triangular, spacing_mm), most_triangular) << count;
        EXPECT_EQ(pairs_apart(square, spacing_mm), most_square) << count;
    }
}

TEST(LatticeFormation, ShellsOfATriangularPatchAreHexagonsAroundTheFirstNode) {
    Arena const arena = shipped("square", 4.0e6);
    FormationSpec spec = lattice(LatticeKind::triangular);
    spec.lattice_spacing_mm = 80.0F;
    spec.centre_mm = {900.0F, 1100.0F};
    for (std::size_t shells = 0; shells <= 6; ++shells) {
        auto const placements = place_seeded(spec, robots(1 + 3 * shells * (shells + 1)), arena, 1);
        EXPECT_NEAR(length(placements[0].position_mm - spec.centre_mm), 0.0F, kTolerance);
        EXPECT_EQ(pairs_apart(placements, 80.0F), 3 * shells * (3 * shells + 1));
        float reach_mm = 0.0F;
        for (Placement const& placement : placements) {
            reach_mm = std::max(reach_mm, length(placement.position_mm - spec.centre_mm));
        }
        EXPECT_NEAR(reach_mm, 80.0F * static_cast<float>(shells), kTolerance);
    }
}

TEST(LatticeFormation, SquarePatchIsCentredWithRowsAndColumnsThatDifferByOneAtMost) {
    Arena const arena = shipped("square", 4.0e6);
    FormationSpec spec = lattice(LatticeKind::square);
    spec.lattice_spacing_mm = 60.0F;
    for (std::size_t rows = 1; rows <= 7; ++rows) {
        for (std::size_t const columns : {rows, rows + 1}) {
            auto const placements = place_seeded(spec, robots(rows * columns), arena, 1);
            Box const box = box_around(placements);
            EXPECT_NEAR(length(box.centre() - arena.bounds.centre()), 0.0F, kTolerance);
            auto const [shorter, longer] =
                std::pair(std::min(box.size().x, box.size().y), std::max(box.size().x, box.size().y));
            EXPECT_NEAR(shorter, 60.0F * static_cast<float>(rows - 1), kTolerance);
            EXPECT_NEAR(longer, 60.0F * static_cast<float>(columns - 1), kTolerance);
            EXPECT_EQ(pairs_apart(placements, 60.0F), 2 * rows * columns - rows - columns);
        }
    }
}

TEST(LatticeFormation, SpacingBelowTheDiameterIsRefused) {
    FormationSpec spec = named("lattice");
    spec.lattice_spacing_mm = 50.0F;
    EXPECT_EQ(error_of(spec, robots(4), shipped("square")),
              "lattice_distance_between_neighbors: 50 mm is too little for 4 objects (largest radius 26.5 mm); it must "
              "be at least 53.56 mm");
}

TEST(LatticeFormation, TooManyForTheArenaAreRefusedWithTheNumberOfNodes) {
    FormationSpec spec = lattice(LatticeKind::square);
    spec.lattice_spacing_mm = 100.0F;
    EXPECT_EQ(
        error_of(spec, robots(101), shipped("square")),
        "initial_formation: 'lattice' has room for only 90 of 101 objects (largest radius 26.5 mm) in this arena; "
        "reduce nb, lower lattice_distance_between_neighbors, or enlarge arena_surface");
}

/// Standard deviation over mean of the distance to the nearest other.
double unevenness(std::vector<Placement> const& placements) {
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < placements.size(); ++i) {
        float nearest = std::numeric_limits<float>::infinity();
        for (std::size_t j = 0; j < placements.size(); ++j) {
            nearest =
                i == j ? nearest : std::min(nearest, length(placements[i].position_mm - placements[j].position_mm));
        }
        sum += nearest;
        squares += static_cast<double>(nearest) * nearest;
    }
    double const mean = sum / static_cast<double>(placements.size());
    return std::sqrt(squares / static_cast<double>(placements.size()) - mean * mean) / mean;
}

TEST(LloydFormation, SpreadsEvenlyUnlikeChance) {
    Arena const arena = shipped("disk");
    for (std::uint64_t const seed : {1, 2, 3}) {
        EXPECT_LT(unevenness(place_seeded(named("lloyd"), robots(60), arena, seed)), 0.15);
        EXPECT_LT(unevenness(place_seeded(named("power_lloyd"), robots(60), arena, seed)), 0.15);
        EXPECT_GT(unevenness(place_seeded(named("random"), robots(60), arena, seed)), 0.25);
    }
}

TEST(LloydFormation, OneRobotStandsAtTheCentroid) {
    for (char const* const name : {"lloyd", "power_lloyd"}) {
        auto const placements = place_seeded(named(name), robots(1), shipped("disk"), 1);
        EXPECT_LT(length(placements[0].position_mm - shipped("disk").bounds.centre()), 10.0F) << name;
    }
}

TEST(LloydFormation, PowerDiagramGivesLargeObjectsMoreRoomThanVoronoi) {
    // One object of radius 200 mm among 60 robots: its nearest neighbour keeps further away than contact.
    std::vector<float> radii = robots(60);
    radii[0] = 200.0F;
    Arena const arena = shipped("disk", 2.0e6);
    auto const gap = [&](char const* name) {
        auto const placements = place_seeded(named(name), radii, arena, 4);
        float nearest = std::numeric_limits<float>::infinity();
        for (std::size_t i = 1; i < radii.size(); ++i) {
            nearest = std::min(nearest, length(placements[i].position_mm - placements[0].position_mm) - 226.5F);
        }
        return nearest;
    };
    EXPECT_GT(gap("power_lloyd"), gap("lloyd") + 10.0F);
}

TEST(LloydFormation, TenThousandRobotsArePlaced) {
    Arena const arena = shipped("disk", 1.0e8);
    std::vector<float> const radii = robots(10000);
    for (char const* const name : {"power_lloyd", "lloyd", "random", "disk", "random_near_walls"}) {
        EXPECT_EQ(place_seeded(named(name), radii, arena, 1).size(), 10000U);
    }
}

TEST(LloydFormation, ThinDiagonalArenaIsPlacedInOrRefused) {
    Arena const sliver = make_arena({{{0, 0}, {20, 0}, {10020, 10000}, {10000, 10000}}});
    std::vector<float> const small(20, 4.0F);
    for (std::string const& name : computed_formations()) {
        FormationSpec spec = named(name);
        try {
            expect_legal(place_seeded(spec, small, sliver, 1), small, sliver, name);
        } catch (ConfigError const& error) {
            EXPECT_TRUE(std::string(error.what()).starts_with("initial_formation: '")) << error.what();
        }
    }
}

}  // namespace
}  // namespace pogosim
