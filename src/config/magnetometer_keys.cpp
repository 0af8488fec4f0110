#include "config/scenario_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "base/exact_math.hpp"
#include "base/log.hpp"
#include "config/lamp_keys.hpp"
#include "config/shape_keys.hpp"

namespace pogosim {

namespace {

constexpr Range kCounts = between(-1e6, 1e6);
constexpr std::string_view kAngles = "angle_unit";
constexpr std::string_view kHarmonics = "a list of maps {order, cos: {x, y, z}, sin: {x, y, z}}";

/// Reads a table, or checks the types of its values if its keys have no effect here.
template <class Keys, class T>
void read_keys(MapReader& reader, Keys const& keys, T& into, bool is_used = true) {
    std::span<Key<T> const> const table(keys);
    if (is_used) {
        reader.read(table, into);
    } else {
        reader.read_unused(table, into);
    }
}

NamedValues<AngleUnit> angle_units() {
    return {{"degrees", AngleUnit::degrees}, {"degree", AngleUnit::degrees}, {"deg", AngleUnit::degrees},
            {"radians", AngleUnit::radians}, {"radian", AngleUnit::radians}, {"rad", AngleUnit::radians}};
}

std::array<Key<MagnetometerConfig>, 3> general_keys() {
    using K = Key<MagnetometerConfig>;
    return {
        K{"source",
          one_of(&MagnetometerConfig::source, {{"procedural", MagnetometerSource::procedural},
                                               {"csv", MagnetometerSource::csv},
                                               {"csv_fit", MagnetometerSource::csv}}),
          any(), "", "procedural: an ellipse with harmonics, from the keys below. csv: a curve fitted to a table."},
        K{"angle_unit", one_of(&MagnetometerConfig::angle_unit, angle_units()), any(), "",
          "Unit of all angles of this map but those in the table."},
        K{"random_seed", &MagnetometerConfig::seed, any(), "",
          "Seed of the differences between robots and of the noise; default: that of the run."},
    };
}

std::array<Key<MagnetometerSpec>, 2> behaviour_keys() {
    using K = Key<MagnetometerSpec>;
    return {
        K{"timing",
          one_of(&MagnetometerSpec::timing,
                 {{"at_once", MagnetometerTiming::at_once}, {"robot", MagnetometerTiming::robot}}),
          any(), "",
          "at_once: each call of magn_read_XYZ measures. robot: new data 50 times per second of the robot's clock; the "
          "call waits for them up to its timeout."},
        K{"scale_signal_with_field_magnitude", &MagnetometerSpec::scales_with_field, any(), "",
          "The signal is proportional to the strength of the horizontal field."},
    };
}

// ---- Angles, which a file has in the unit of the map ----

/// Returns the angle under a key as it is in the file; it is 0, or absent, by default.
template <class Angle>
Angle read_angle(MapReader& reader, std::string_view name, std::string_view doc, bool is_used = true) {
    struct InFile {
        Angle angle{};
    };
    InFile in_file;
    read_keys(reader, std::array{Key<InFile>{name, &InFile::angle, any(), kAngles, doc}}, in_file, is_used);
    return in_file.angle;
}

double in_radians(double angle, AngleUnit unit) {
    return angle * radians_in(unit);
}

Interval in_radians(Interval const& angles, AngleUnit unit) {
    return {in_radians(angles.min, unit), in_radians(angles.max, unit)};
}

template <class Angle>
std::optional<Angle> in_radians(std::optional<Angle> const& angle, AngleUnit unit) {
    return angle ? std::optional(in_radians(*angle, unit)) : std::nullopt;
}

bool looks_like_radians(std::vector<double> const& degrees) {
    return !degrees.empty() &&
           std::ranges::all_of(degrees, [](double angle) { return std::abs(angle) <= kAngle.usual_max; }) &&
           std::ranges::any_of(degrees, [](double angle) { return angle != std::round(angle); });
}

/// Warns of an angle that is none in the unit of the map. In degrees, only a direction in the arena can be recognised:
/// an offset may well be small.
void warn_of_other_unit(MapReader const& reader, std::string_view key, AngleUnit unit, bool is_direction = false) {
    Node const* const node = reader.find(key);
    if (node == nullptr) {
        return;
    }
    std::vector<double> angles;
    for (Node const& angle : node->kind == Node::Kind::sequence ? node->items : std::vector{*node}) {
        if (auto const number = number_of(angle)) {
            angles.push_back(*number);
        }
    }
    Place const place{*node, reader.path_of(key)};
    UnitSlips slips;
    if (unit == AngleUnit::radians) {
        slips.look_at(place, {.range = any().usually_up_to(kAngle.usual_max), .unit = "rad"});
    } else if (is_direction && looks_like_radians(angles)) {
        slips.look_at(place, {.range = any().usually_from(kAngle.usual_max), .unit = "degrees"});
    }
    slips.warn();
}

// ---- world_field: three ways to say the field at the origin. ----

enum class FieldForm { vector, components, polar };

struct FieldAtOrigin {
    FieldForm form = FieldForm::components;
    Axes vector{1.0, 0.0, 0.0};
    double x = 1.0;
    double y = 0.0;
    double z = 0.0;
    double north_angle = 0.0;
    double horizontal = 1.0;
    double vertical = 0.0;
};

constexpr std::array kComponentKeys{"x", "y", "z"};
constexpr std::array kPolarKeys{"magnetic_north_angle", "horizontal_magnitude", "vertical_component"};

std::array<Key<FieldAtOrigin>, 7> field_keys() {
    using K = Key<FieldAtOrigin>;
    constexpr auto is_vector = [](FieldAtOrigin const& field) { return field.form == FieldForm::vector; };
    constexpr auto is_components = [](FieldAtOrigin const& field) { return field.form == FieldForm::components; };
    constexpr auto is_polar = [](FieldAtOrigin const& field) { return field.form == FieldForm::polar; };
    return {
        K{"vector", &FieldAtOrigin::vector, kCounts, "", "Field at the origin, [x, y, z], y down; in any unit."}
            .only_if(is_vector),
        K{"x", &FieldAtOrigin::x, kCounts, "", "The same by components."}.only_if(is_components),
        K{"y", &FieldAtOrigin::y, kCounts, "", "See x."}.only_if(is_components),
        K{"z", &FieldAtOrigin::z, kCounts, "", "See x."}.only_if(is_components),
        K{"magnetic_north_angle", &FieldAtOrigin::north_angle, any(), kAngles,
          "The same by the direction of its horizontal part, clockwise on the screen from +x,"}
            .only_if(is_polar),
        K{"horizontal_magnitude", &FieldAtOrigin::horizontal, between(0, 1e6), "", "the size of that part,"}.only_if(
            is_polar),
        K{"vertical_component", &FieldAtOrigin::vertical, kCounts, "", "and its vertical part."}.only_if(is_polar),
    };
}

std::array<Key<MagneticField>, 3> gradient_keys() {
    using K = Key<MagneticField>;
    return {
        K{"gradient_x", &MagneticField::gradient_x, kCounts, "per mm", "Change of the field along x, [x, y, z]."},
        K{"gradient_y", &MagneticField::gradient_y, kCounts, "per mm", "Change of the field along y."},
        K{"origin", &MagneticField::origin_mm, kCoordinate, "mm", "Where the field is that of the keys above."},
    };
}

bool is_any_given(MapReader const& reader, std::span<char const* const> keys) {
    return std::ranges::any_of(keys, [&](char const* key) { return reader.find(key) != nullptr; });
}

/// The first form that is given; a warning names keys of another one.
FieldForm form_of_field(MapReader const& reader) {
    bool const has_vector = reader.find("vector") != nullptr;
    bool const has_components = is_any_given(reader, kComponentKeys);
    bool const has_polar = is_any_given(reader, kPolarKeys);
    if ((has_vector && (has_components || has_polar)) || (has_components && has_polar)) {
        log().warn("{}: {}: the field is given in several ways; {} used, and {} ignored", reader.place().node.where(),
                   reader.place().path, has_vector ? "'vector' is" : "'x', 'y' and 'z' are",
                   has_vector && has_components
                       ? "the components are"
                       : "magnetic_north_angle, horizontal_magnitude and vertical_component are");
    }
    return has_vector ? FieldForm::vector : !has_components && has_polar ? FieldForm::polar : FieldForm::components;
}

Axes field_at_origin(FieldAtOrigin const& field, double unit_rad) {
    switch (field.form) {
        case FieldForm::vector:
            return field.vector;
        case FieldForm::components:
            return {field.x, field.y, field.z};
        case FieldForm::polar:
            break;
    }
    auto const [sine, cosine] = exact::sine_cosine(field.north_angle * unit_rad);
    return {field.horizontal * cosine, field.horizontal * sine, field.vertical};
}

void read_field(MapReader& reader, MagnetometerConfig& config) {
    MagneticField& field = config.spec.field;
    FieldAtOrigin at_origin{.form = form_of_field(reader)};
    read_keys(reader, field_keys(), at_origin);
    read_keys(reader, gradient_keys(), field);
    if (at_origin.form == FieldForm::polar) {
        warn_of_other_unit(reader, "magnetic_north_angle", config.angle_unit, /*is_direction=*/true);
    }
    field.at_origin = field_at_origin(at_origin, radians_in(config.angle_unit));
    if (config.spec.scales_with_field && field.at_origin[0] == 0.0 && field.at_origin[1] == 0.0) {
        log().warn("{}: {}: the field has no horizontal part at its origin, so readings do not depend on the heading",
                   reader.place().node.where(), reader.place().path);
    }
}

// ---- domain ----

std::array<Key<MagneticDomain>, 2> place_keys() {
    using K = Key<MagneticDomain>;
    return {
        K{"x", &MagneticDomain::x_mm, kCoordinate, "mm", "Positions for which the model is meant; default: all."},
        K{"y", &MagneticDomain::y_mm, kCoordinate, "mm", "See x."},
    };
}

std::array<Key<MagneticDomain>, 2> policy_keys() {
    using K = Key<MagneticDomain>;
    return {
        K{"wrap_theta", &MagneticDomain::wrap_heading, any(), "", "Headings count modulo a turn."},
        K{"policy",
          one_of(&MagneticDomain::policy, {{"allow", DomainPolicy::allow},
                                           {"clamp", DomainPolicy::clamp},
                                           {"throw", DomainPolicy::refuse},
                                           {"throw_error", DomainPolicy::refuse}}),
          any(), "",
          "Outside: allow: as inside. clamp: as at the nearest place and heading inside. throw: the run ends with an "
          "error."},
    };
}

void read_domain(MapReader& reader, AngleUnit unit, MagneticDomain& domain) {
    read_keys(reader, place_keys(), domain);
    auto const theta =
        read_angle<std::optional<Interval>>(reader, "theta", "Headings for which it is meant; default: all.");
    read_keys(reader, policy_keys(), domain);
    warn_of_other_unit(reader, "theta", unit, /*is_direction=*/true);
    for (auto const& [key, interval] : {std::pair{"x", domain.x_mm}, {"y", domain.y_mm}, {"theta", theta}}) {
        if (interval && !(interval->min < interval->max)) {
            fail_at({*reader.find(key), reader.path_of(key)},
                    fmt::format("expected [smallest, largest], found {}", value_text(*interval)));
        }
    }
    domain.heading_rad = in_radians(theta, unit);
}

// ---- Intervals of the three axes ----

std::array<Key<AxisIntervals>, 3> axis_keys(Range const& range, std::string_view unit, std::string_view doc) {
    using K = Key<AxisIntervals>;
    return {K{"x", &AxisIntervals::x, range, unit, doc}, K{"y", &AxisIntervals::y, range, unit, "See x."},
            K{"z", &AxisIntervals::z, range, unit, "See x."}};
}

/// The map of x, y and z under a key.
struct AxisMap {
    std::string_view key;
    AxisIntervals& intervals;
    Range range;
    std::string_view doc;
};

void read_axes(MapReader& reader, AxisMap const& map, bool is_used = true) {
    reader.read_map(map.key, [&](MapReader& inner) {
        read_keys(inner, axis_keys(map.range, "counts", map.doc), map.intervals, is_used);
    });
}

void read_output(MapReader& reader, MagnetometerOutput& output) {
    using K = Key<MagnetometerOutput>;
    read_keys(reader,
              std::array{
                  K{"quantization_step", &MagnetometerOutput::quantization_step, kCounts, "counts",
                    "Readings are multiples of it; 0 or less: they are rounded to whole counts alone."},
                  K{"clamp", &MagnetometerOutput::clamp, any(), "", "Limit the readings to `limits`."},
              },
              output);
    read_axes(reader, {"limits", output.limits, kCounts, "Smallest and largest reading with `clamp`."}, output.clamp);
}

void read_variation(MapReader& reader, AngleUnit unit, MagnetometerVariation& variation) {
    using K = Key<MagnetometerVariation>;
    read_axes(reader, {"additional_bias", variation.additional_bias, kCounts, "Added to the centre of the curve."});
    read_keys(reader,
              std::array{
                  K{"signal_gain", &MagnetometerVariation::signal_gain, kCounts, "", "Factor of the curve's size."},
              },
              variation);
    variation.angle_offset_rad = in_radians(
        read_angle<Interval>(reader, "angle_offset", "Added to the angle of the field in the robot's frame."), unit);
    warn_of_other_unit(reader, "angle_offset", unit);
    read_axes(reader, {"noise_stddev", variation.noise_stddev, between(0, 1e6),
                       "Standard deviation of Gaussian noise on each reading."});
}

// ---- procedural ----

std::array<Key<MagneticEllipse>, 2> radius_keys() {
    using K = Key<MagneticEllipse>;
    constexpr Range radius = between(0, 1e6);
    return {
        K{"major_radius", &MagneticEllipse::major_radius, radius, "counts",
          "Half the long axis of the ellipse of x and y."},
        K{"minor_radius", &MagneticEllipse::minor_radius, radius, "counts", "Half its short axis."},
    };
}

std::array<Key<MagneticEllipse>, 2> vertical_keys() {
    using K = Key<MagneticEllipse>;
    return {
        K{"z_cos_amplitude", &MagneticEllipse::z_cosine, kCounts, "counts", "z by the cosine of that angle."},
        K{"z_sin_amplitude", &MagneticEllipse::z_sine, kCounts, "counts", "z by its sine."},
    };
}

/// The other way round, the same ellipse is turned by 90 degrees.
void warn_of_radii(MapReader const& reader, MagneticEllipse const& ellipse) {
    bool const is_written = reader.find("major_radius") != nullptr || reader.find("minor_radius") != nullptr;
    if (is_written && ellipse.minor_radius.max > ellipse.major_radius.max) {
        log().warn(
            "{}: {}: minor_radius, {}, goes above major_radius, {}: the long axis is then at 90 degrees to "
            "ellipse_rotation; if it should not be, exchange them",
            reader.place().node.where(), reader.place().path, value_text(ellipse.minor_radius),
            value_text(ellipse.major_radius));
    }
}

void read_ellipse(MapReader& reader, AngleUnit unit, MagneticEllipse& ellipse, bool is_used) {
    read_axes(reader, {"center", ellipse.centre, kCounts, "Centre of the curve."}, is_used);
    read_keys(reader, radius_keys(), ellipse, is_used);
    ellipse.rotation_rad = in_radians(
        read_angle<Interval>(reader, "ellipse_rotation", "Angle of the major axis from the x axis.", is_used), unit);
    ellipse.phase_offset_rad =
        in_radians(read_angle<Interval>(reader, "sensor_phase_offset",
                                        "Added to the angle of the field in the robot's frame.", is_used),
                   unit);
    read_keys(reader, vertical_keys(), ellipse, is_used);
    if (is_used) {
        warn_of_other_unit(reader, "ellipse_rotation", unit);
        warn_of_other_unit(reader, "sensor_phase_offset", unit);
        warn_of_radii(reader, ellipse);
    }
}

void read_harmonic(MapReader& reader, MagneticHarmonic& harmonic, bool is_used) {
    using K = Key<MagneticHarmonic>;
    read_keys(reader,
              std::array{K{"order", &MagneticHarmonic::order, between(2, kHighestHarmonic), "",
                           "Periods of the harmonic in a turn."}},
              harmonic, is_used);
    read_axes(reader, {"cos", harmonic.cosine, kCounts, "Amplitudes of the cosine."}, is_used);
    read_axes(reader, {"sin", harmonic.sine, kCounts, "Amplitudes of the sine."}, is_used);
}

Node default_harmonics() {
    Node list;
    list.kind = Node::Kind::sequence;
    for (MagneticHarmonic harmonic : MagnetometerSpec().harmonics) {
        Node const nothing;
        Reading reading;
        MapReader reader(nothing, "", reading);
        read_harmonic(reader, harmonic, true);
        list.items.push_back(reader.values());
    }
    return list;
}

/// A list that is given replaces the default one.
void read_harmonics(MapReader& reader, std::vector<MagneticHarmonic>& harmonics, bool is_used) {
    struct Nothing {};
    Nothing nothing;
    read_keys(reader,
              std::array{Key<Nothing>{"distortion_harmonics", Elsewhere{kHarmonics}, any(), "",
                                      "Deviations from the ellipse; a list replaces the default one, which is order 2 "
                                      "with cos x 12, cos y -6 and sin y 4 counts."}},
              nothing);
    Node const* const list = reader.find("distortion_harmonics");
    Node values = default_harmonics();
    if (list != nullptr) {
        Place const place{*list, reader.path_of("distortion_harmonics")};
        if (list->kind != Node::Kind::sequence) {
            fail_expected(place, kHarmonics);
        }
        harmonics.clear();
        values.items.clear();
        for (std::size_t i = 0; i < list->items.size(); ++i) {
            MapReader inner(list->items[i], fmt::format("{}.{}", place.path, i), reader.reading());
            read_harmonic(inner, harmonics.emplace_back(), is_used);
            inner.finish();
            values.items.push_back(inner.values());
        }
    }
    if (is_used) {
        reader.set_value("distortion_harmonics", std::move(values));
    }
}

void read_procedural(MapReader& reader, AngleUnit unit, MagnetometerSpec& spec, bool is_used) {
    reader.read_map("ellipse", [&](MapReader& inner) { read_ellipse(inner, unit, spec.ellipse, is_used); });
    read_harmonics(reader, spec.harmonics, is_used);
}

// ---- csv ----

std::array<Key<MagnetometerTable>, 9> table_keys() {
    using K = Key<MagnetometerTable>;
    return {
        K{"file", &MagnetometerTable::file, any(), "",
          "Table of headings and readings (CSV), needed for source csv; searched like arena_file."},
        K{"has_header", &MagnetometerTable::has_header, any(), "", "Its first line names the columns."},
        K{"delimiter", &MagnetometerTable::delimiter, any(), "", "The character between two fields."},
        K{"comment_prefix", &MagnetometerTable::comment_prefix, any(), "",
          "Lines that begin with it are skipped; empty: none are."},
        K{"input_angle_unit", one_of(&MagnetometerTable::angle_unit, angle_units()), any(), "",
          "Unit of the table's headings."},
        K{"harmonic_order", &MagnetometerTable::harmonic_order, between(1, kHighestHarmonic), "",
          "Harmonics K of the fitted curve; it needs at least 1 + 2 K different headings."},
        K{"ridge_regularization", &MagnetometerTable::ridge, between(0, 1e12), "",
          "Weight of the squared coefficients in the fit."},
        K{"skip_invalid_rows", &MagnetometerTable::skip_invalid_rows, any(), "",
          "Skip rows that are not numbers, or whose readings do not have 16 bits, with a warning; false: they are "
          "errors."},
        K{"add_fit_residual_as_noise", &MagnetometerTable::residual_is_noise, any(), "",
          "Add the error of the fit to noise_stddev, in quadrature."},
    };
}

template <class Column>
std::array<Key<MagnetometerColumns<Column>>, 4> column_keys(Range const& range, std::string_view doc) {
    using Columns = MagnetometerColumns<Column>;
    using K = Key<Columns>;
    return {K{"angle", &Columns::angle, range, "", doc}, K{"x", &Columns::x, range, "", "See angle."},
            K{"y", &Columns::y, range, "", "See angle."}, K{"z", &Columns::z, range, "", "See angle."}};
}

void refuse_delimiter(MapReader const& reader, MagnetometerTable const& table) {
    constexpr std::string_view kNotBetweenFields = "\"\r\n0123456789+-.eE";
    if (table.delimiter.size() != 1 || kNotBetweenFields.find(table.delimiter) != std::string_view::npos) {
        Node const* const node = reader.find("delimiter");
        fail_at(
            {*node, reader.path_of("delimiter")},
            fmt::format("expected one character that is not part of a number, such as ',', ';' or \"\\t\", found {}",
                        found_text(*node)));
    }
}

void read_table(MapReader& reader, AngleUnit unit, MagnetometerTable& table, bool is_used) {
    read_keys(reader, table_keys(), table, is_used);
    table.field_angle_rad = in_radians(
        read_angle<std::optional<double>>(reader, "calibration_field_angle",
                                          "Direction of the field where the table was recorded; default: that of "
                                          "world_field.",
                                          is_used),
        unit);
    if (is_used) {
        warn_of_other_unit(reader, "calibration_field_angle", unit, /*is_direction=*/true);
    }
    reader.read_map("columns", [&](MapReader& inner) {
        read_keys(inner, column_keys<std::string>(any(), "Names of the columns, with a header."), table.columns,
                  is_used && table.has_header);
    });
    reader.read_map("column_indices", [&](MapReader& inner) {
        read_keys(inner, column_keys<int>(between(0, 1000), "Places of the columns from 0, without a header."),
                  table.column_indices, is_used && !table.has_header);
    });
    if (is_used) {
        refuse_delimiter(reader, table);
    }
}

bool is_given(Node const* source) {
    return source != nullptr && source->kind != Node::Kind::null;
}

/// Whether the source is not one that is an error: the other map may be that of the one that was meant.
bool is_procedural(Node const* source) {
    return !is_given(source) || source->scalar == "procedural";
}

/// A map that has keys, but not the source that it is for.
void warn_of_unused_map(MapReader const& reader, std::string_view key, std::string_view source,
                        std::string_view advice) {
    Node const* const map = reader.find(key);
    if (map != nullptr && !map->entries.empty()) {
        log().warn("{}: {}: has no effect with source: {}{}; {}", map->where(), reader.path_of(key), source,
                   is_given(reader.find("source")) ? "" : ", the default", advice);
    }
}

}  // namespace

MagnetometerConfig read_magnetometer_map(MapReader& reader) {
    MagnetometerConfig config;
    MagnetometerSpec& spec = config.spec;
    read_keys(reader, general_keys(), config);
    read_keys(reader, behaviour_keys(), spec);
    AngleUnit const unit = config.angle_unit;
    bool const has_table = config.source == MagnetometerSource::csv;
    reader.read_map("world_field", [&](MapReader& inner) { read_field(inner, config); });
    reader.read_map("domain", [&](MapReader& inner) { read_domain(inner, unit, spec.domain); });
    reader.read_map("output", [&](MapReader& inner) { read_output(inner, spec.output); });
    reader.read_map("robot_variation", [&](MapReader& inner) { read_variation(inner, unit, spec.variation); });
    reader.read_map("procedural", [&](MapReader& inner) { read_procedural(inner, unit, spec, !has_table); });
    reader.read_map("csv", [&](MapReader& inner) { read_table(inner, unit, config.table, has_table); });
    if (has_table) {
        warn_of_unused_map(reader, "procedural", "csv", "remove it, or set source: procedural");
    } else if (is_procedural(reader.find("source"))) {
        warn_of_unused_map(reader, "csv", "procedural", "set source: csv, or remove it");
    }
    if (has_table && config.table.file.empty()) {
        fail_at({*reader.find("source"), reader.path_of("source")},
                "csv needs csv.file, a table of headings and readings");
    }
    return config;
}

MagnetometerConfig read_magnetometer(MapReader& top) {
    MagnetometerConfig config;
    top.read_map("magnetometer", kMagnetometerMap, [&](MapReader& map) { config = read_magnetometer_map(map); });
    return config;
}

}  // namespace pogosim
