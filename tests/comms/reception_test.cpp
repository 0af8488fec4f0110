#include "comms/reception.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace pogosim {
namespace {

struct Measurement {
    int payload_bytes;
    int neighbours;
    double send_probability;
    double success;
};

// Measured on real robots (the article, figure of reception success): short messages, 60 Hz, mean of 10 runs.
constexpr std::array kMeasurements{
    Measurement{3, 6, 0.1, 0.996},   Measurement{3, 6, 0.2, 0.976},   Measurement{3, 6, 0.5, 0.833},
    Measurement{3, 6, 0.8, 0.604},   Measurement{3, 6, 1.0, 0.429},   Measurement{3, 2, 0.1, 0.972},
    Measurement{3, 2, 0.2, 0.978},   Measurement{3, 2, 0.5, 0.988},   Measurement{3, 2, 0.8, 0.997},
    Measurement{3, 2, 1.0, 0.996},   Measurement{3, 1, 0.1, 0.968},   Measurement{3, 1, 0.2, 0.980},
    Measurement{3, 1, 0.5, 0.982},   Measurement{3, 1, 0.8, 0.996},   Measurement{3, 1, 1.0, 1.000},
    Measurement{20, 6, 0.1, 0.995},  Measurement{20, 6, 0.2, 0.988},  Measurement{20, 6, 0.5, 0.903},
    Measurement{20, 6, 0.8, 0.349},  Measurement{20, 6, 1.0, 0.272},  Measurement{20, 2, 0.1, 0.997},
    Measurement{20, 2, 0.2, 0.998},  Measurement{20, 2, 0.5, 0.998},  Measurement{20, 2, 0.8, 0.997},
    Measurement{20, 2, 1.0, 0.999},  Measurement{20, 1, 0.1, 0.997},  Measurement{20, 1, 0.2, 0.996},
    Measurement{20, 1, 0.5, 1.000},  Measurement{20, 1, 0.8, 0.988},  Measurement{20, 1, 1.0, 1.000},
    Measurement{100, 6, 0.1, 0.772}, Measurement{100, 6, 0.2, 0.366}, Measurement{100, 6, 0.5, 0.023},
    Measurement{100, 6, 0.8, 0.013}, Measurement{100, 6, 1.0, 0.006}, Measurement{100, 2, 0.1, 0.725},
    Measurement{100, 2, 0.2, 0.779}, Measurement{100, 2, 0.5, 0.645}, Measurement{100, 2, 0.8, 0.351},
    Measurement{100, 2, 1.0, 0.080}, Measurement{100, 1, 0.1, 0.707}, Measurement{100, 1, 0.2, 0.753},
    Measurement{100, 1, 0.5, 0.637}, Measurement{100, 1, 0.8, 0.336}, Measurement{100, 1, 1.0, 0.047}};

constexpr int kShortHeaderBytes = 3;

struct Fit {
    double r2 = 0.0;
    double mean_absolute_error = 0.0;
};

/// How well a law predicts the measurements.
Fit fit_of(ReceptionSpec const& law) {
    double mean = 0.0;
    for (Measurement const& m : kMeasurements) {
        mean += m.success / kMeasurements.size();
    }
    double squared_residuals = 0.0;
    double squared_deviations = 0.0;
    double absolute_residuals = 0.0;
    for (Measurement const& m : kMeasurements) {
        double const predicted =
            reception_probability(law, m.payload_bytes + kShortHeaderBytes, m.send_probability, m.neighbours + 1);
        squared_residuals += std::pow(m.success - predicted, 2);
        squared_deviations += std::pow(m.success - mean, 2);
        absolute_residuals += std::abs(m.success - predicted);
    }
    return {1.0 - squared_residuals / squared_deviations, absolute_residuals / kMeasurements.size()};
}

TEST(Reception, ArticleEquationFitsTheMeasurementsAsWellAsTheArticleSays) {
    Fit const fit = fit_of({});
    EXPECT_NEAR(fit.r2, 0.914975, 5e-7);
    EXPECT_NEAR(fit.mean_absolute_error, 0.066285, 5e-7);
}

TEST(Reception, FourParameterLawFitsTheMeasurementsAsWellAsItsPageSays) {
    Fit const fit = fit_of(four_parameter_law());
    EXPECT_NEAR(fit.r2, 0.708184, 5e-7);
    EXPECT_NEAR(fit.mean_absolute_error, 0.107684, 5e-7);
}

TEST(Reception, PowerLawGivesItsReferenceValues) {
    ReceptionSpec const spec{
        .law = ReceptionLaw::power, .alpha = 1e-6, .beta = 3.0708, .gamma = 2.3234, .delta = 1.1897};
    EXPECT_NEAR(reception_probability(spec, 12, 0.5, 7), 0.9958, 5e-5);
    EXPECT_NEAR(reception_probability(spec, 12, 1.0, 7), 0.9796, 5e-5);
    EXPECT_NEAR(reception_probability(spec, 30, 0.5, 3), 0.9753, 5e-5);
    EXPECT_NEAR(reception_probability(spec, 110, 0.5, 3), 0.4218, 5e-5);
    EXPECT_NEAR(reception_probability(spec, 110, 1.0, 7), 0.0505, 5e-5);
}

TEST(Reception, ConstantLawIgnoresEverything) {
    ReceptionSpec const spec{.law = ReceptionLaw::constant, .rate = 0.3};
    EXPECT_DOUBLE_EQ(reception_probability(spec, 12, 0.5, 7), 0.3);
    EXPECT_DOUBLE_EQ(reception_probability(spec, 300, 1.0, 50), 0.3);
}

TEST(Reception, ProbabilitiesStayBetweenZeroAndOneForAnyParameters) {
    for (double const parameter : {-1e6, -1.0, 0.0, 1e-9, 1.0, 1e6}) {
        for (ReceptionLaw const law : {ReceptionLaw::article, ReceptionLaw::power}) {
            ReceptionSpec const spec{law, parameter, parameter, parameter, parameter, parameter, parameter, parameter};
            for (double const p : {0.0, 0.5, 1.0}) {
                double const probability = reception_probability(spec, 385, p, 60);
                EXPECT_GE(probability, 0.0);
                EXPECT_LE(probability, 1.0);
            }
        }
    }
}

/// More kinds of messages than a table has rows, several of each row.
TEST(ReceptionTable, GivesWhatTheLawGivesForMessagesOfAllKindsInAnyOrder) {
    ReceptionSpec spec;
    spec.law = ReceptionLaw::article;
    ReceptionTable table;
    for (int round = 0; round < 2; ++round) {
        for (std::uint32_t cluster_size = 1; cluster_size < 40; ++cluster_size) {
            for (float const send_probability : {0.1F, 0.5F, 1.0F}) {
                for (std::uint16_t const message_bytes : {3, 4, 11, 100, 267}) {  // 11 and 267 share rows
                    auto const expected =
                        static_cast<float>(reception_probability(spec, message_bytes, send_probability, cluster_size));
                    EXPECT_EQ(table.probability(spec, message_bytes, send_probability, cluster_size), expected);
                }
            }
        }
    }
}

}  // namespace
}  // namespace pogosim
