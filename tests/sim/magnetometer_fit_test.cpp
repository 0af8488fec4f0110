// Curves fitted to tables of readings.
#include "sim/magnetometer_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "base/random.hpp"
#include "device/magnetometer.hpp"

namespace pogosim {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Three harmonics, each axis with its own.
MagneticCurve some_curve() {
    MagneticCurve curve{.constant = {412.0, 437.0, 431.0}, .order = 3};
    for (std::size_t k = 0; k < 3; ++k) {
        double const size = 150.0 / static_cast<double>((k + 1) * (k + 1));
        curve.cosine[k] = {size, -0.2 * size, 0.1 * size};
        curve.sine[k] = {0.1 * size, 0.9 * size, -5.0};
    }
    return curve;
}

/// The readings of that curve, evenly around the turn.
std::vector<MagneticRow> rows_of(MagneticCurve const& curve, int count, double noise = 0.0) {
    MagnetometerSpec spec;
    spec.fitted = curve;
    MagnetometerProfile const profile = profile_of(spec, 0);
    RandomStream stream(3, 4);
    std::vector<MagneticRow> rows;
    for (int i = 0; i < count; ++i) {
        double const angle = kTurn * i / count;
        Axes reading = noiseless_reading(spec, profile, {.position_mm = {}, .heading_rad = static_cast<float>(-angle)});
        for (double& value : reading) {
            value += noise * static_cast<double>(stream.normal());
        }
        rows.push_back({.angle_rad = angle, .reading = reading});
    }
    return rows;
}

void expect_near(Axes const& found, Axes const& expected, double tolerance) {
    for (std::size_t axis = 0; axis < found.size(); ++axis) {
        EXPECT_NEAR(found[axis], expected[axis], tolerance);
    }
}

TEST(MagnetometerFit, RecoversTheCoefficients) {
    MagneticCurve const curve = some_curve();
    auto const fit = fit_magnetic_curve(rows_of(curve, 72), 3, 0.0);
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->curve.order, 3);
    expect_near(fit->curve.constant, curve.constant, 1e-4);
    for (std::size_t k = 0; k < 3; ++k) {
        expect_near(fit->curve.cosine[k], curve.cosine[k], 1e-4);
        expect_near(fit->curve.sine[k], curve.sine[k], 1e-4);
    }
    expect_near(fit->rms_error, {}, 1e-4);  // headings are float
}

TEST(MagnetometerFit, ErrorIsTheNoiseOfTheTable) {
    auto const fit = fit_magnetic_curve(rows_of(some_curve(), 2000, 4.0), 3, 0.0);
    ASSERT_TRUE(fit);
    expect_near(fit->rms_error, {4.0, 4.0, 4.0}, 0.3);
    expect_near(fit->curve.constant, some_curve().constant, 0.4);
}

TEST(MagnetometerFit, HarmonicsThatAreLeftOutAreInTheError) {
    MagneticCurve const curve = some_curve();
    auto const fit = fit_magnetic_curve(rows_of(curve, 72), 2, 0.0);
    ASSERT_TRUE(fit);
    expect_near(fit->curve.cosine[1], curve.cosine[1], 1e-4);  // evenly spread headings tell harmonics apart
    double const left_out = std::hypot(curve.cosine[2][0], curve.sine[2][0]) / std::sqrt(2.0);
    EXPECT_NEAR(fit->rms_error[0], left_out, 1e-3);
}

TEST(MagnetometerFit, RidgeShrinksAllCoefficientsButTheConstant) {
    MagneticCurve const curve = some_curve();
    constexpr int count = 72;
    auto const fit = fit_magnetic_curve(rows_of(curve, count), 3, count / 2.0);  // as much as the data say
    ASSERT_TRUE(fit);
    expect_near(fit->curve.constant, curve.constant, 1e-3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(fit->curve.cosine[0][axis], curve.cosine[0][axis] / 2.0, 1e-3);
        EXPECT_NEAR(fit->curve.sine[2][axis], curve.sine[2][axis] / 2.0, 1e-3);
    }
}

TEST(MagnetometerFit, AsManyRowsAsCoefficientsAreEnough) {
    MagneticCurve const curve = some_curve();
    auto const fit = fit_magnetic_curve(rows_of(curve, 7), 3, 1e-8);
    ASSERT_TRUE(fit);
    expect_near(fit->curve.sine[2], curve.sine[2], 1e-3);
    EXPECT_FALSE(fit_magnetic_curve(rows_of(curve, 6), 3, 1e-8));
}

TEST(MagnetometerFit, HeadingsThatDetermineNoCurveGiveNone) {
    std::vector<MagneticRow> rows = rows_of(some_curve(), 4);
    for (int i = 0; i < 5; ++i) {
        rows.insert(rows.end(), rows.begin(), rows.begin() + 4);
    }
    EXPECT_FALSE(fit_magnetic_curve(rows, 2, 0.0));
    EXPECT_FALSE(fit_magnetic_curve(rows, 2, 1e-8));
    EXPECT_TRUE(fit_magnetic_curve(rows, 1, 1e-8));
    EXPECT_FALSE(fit_magnetic_curve({}, 1, 1e-8));
}

TEST(MagnetometerFit, HighestOrderIsFittedToo) {
    MagneticCurve curve{.constant = {1.0, 2.0, 3.0}, .order = kHighestHarmonic};
    curve.cosine.back() = {7.0, 8.0, 9.0};
    auto const fit = fit_magnetic_curve(rows_of(curve, 200), kHighestHarmonic, 0.0);
    ASSERT_TRUE(fit);
    expect_near(fit->curve.cosine.back(), curve.cosine.back(), 1e-3);
}

}  // namespace
}  // namespace pogosim
