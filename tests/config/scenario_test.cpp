#include "config/scenario.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/places.hpp"
#include "config/source.hpp"
#include "config/tree.hpp"
#include "config_file.hpp"
#include "lamps/alternating_rays_lamp.hpp"
#include "lamps/lamp_types.hpp"
#include "lamps/rotating_ray_lamp.hpp"
#include "lamps/spot_lamp.hpp"

using namespace pogosim;
using namespace pogosim::config_file;

namespace {

RobotSpec robot(std::string const& keys) {
    return *load(kRobots + keys).objects.at(0).spec.robot;
}

SpotSpec spot_of(ObjectConfig const& object) {
    return *object.spec.lamp->get_if<SpotSpec>();
}

SpotSpec lamp(std::string const& keys) {
    return spot_of(load(kLamp + keys).objects.at(1));
}

ReceptionSpec reception(std::string const& map) {
    return robot("    msg_success_rate: " + map + "\n").ir.reception;
}

}  // namespace

TEST(Scenario, DefaultsAreThoseOfTheConfigurationSheet) {
    Warnings const warnings;
    Scenario const s = load("unrelated: 1\n");
    EXPECT_EQ(s.arena_file, "");
    EXPECT_EQ(s.arena_surface_mm2, 1.0e6);
    EXPECT_FALSE(s.arena_stretch);
    EXPECT_EQ(s.boundary, BoundaryCondition::solid);
    EXPECT_EQ(s.walls.friction, 0.05F);
    EXPECT_EQ(s.walls.restitution, 0.5F);
    EXPECT_FALSE(s.ignore_occlusions);
    EXPECT_FALSE(s.walls.block_infrared);
    EXPECT_EQ(s.arena_temperature_c, 42.0);
    EXPECT_EQ(s.simulation_time_s, 100.0);
    EXPECT_EQ(s.time_step_s, 0.01);
    EXPECT_EQ(s.seed, std::nullopt);
    EXPECT_EQ(s.light_map_columns, 100);
    EXPECT_EQ(s.light_map_rows, 100);
    EXPECT_TRUE(s.objects.empty());

    FormationSpec const& f = s.formation;
    EXPECT_EQ(f.name, "power_lloyd");
    EXPECT_EQ(f.root_object, "arena");
    EXPECT_TRUE(std::isnan(f.centre_mm.x) && std::isnan(f.centre_mm.y));
    EXPECT_EQ(f.min_space_mm, 0.0F);
    EXPECT_TRUE(std::isinf(f.max_space_mm));
    EXPECT_EQ(f.attempts_per_point, 100);
    EXPECT_EQ(f.max_restarts, 100);
    EXPECT_EQ(f.chessboard_pitch_mm, 100.0F);
    EXPECT_EQ(f.lattice_kind, LatticeKind::triangular);
    EXPECT_EQ(f.lattice_spacing_mm, std::nullopt);
    EXPECT_TRUE(f.cluster_at_centre);
    EXPECT_EQ(f.filename, "");
    EXPECT_TRUE(std::isnan(f.imported_min.x) && std::isnan(f.imported_max.y));

    ViewConfig const& v = s.view;
    EXPECT_EQ(v.window_width_px, 800);
    EXPECT_EQ(v.window_height_px, 800);
    EXPECT_EQ(v.gui_speed_up, 1.0);
    EXPECT_EQ(v.mm_to_pixels, 1.0);
    EXPECT_TRUE(v.gui && v.time && v.scale_bar && v.lateral_leds);
    EXPECT_FALSE(v.show_communication_channels || v.show_communication_channels_above_all || v.light_levels ||
                 v.trails || v.delete_old_files);
    EXPECT_EQ(v.save_video_period_s, -1.0);
    EXPECT_EQ(v.frames_name, "frames/f{:010.4f}.png");

    OutputConfig const& o = s.output;
    EXPECT_TRUE(o.enable_data_logging);
    EXPECT_EQ(o.data_filename, "data.feather");
    EXPECT_EQ(o.save_data_period_s, 1.0);
    EXPECT_EQ(o.fields, std::nullopt);
    EXPECT_EQ(o.categories, std::nullopt);
    EXPECT_EQ(o.flush_row_count, 65536);
    EXPECT_FALSE(o.led_column || o.enable_console_logging);
    EXPECT_EQ(o.console_filename, "console.txt");
    EXPECT_EQ(o.message_log, "");
    EXPECT_EQ(o.log_format, LogFormat::dated);
}

TEST(Scenario, DefaultsOfRobotsAreThoseOfTheConfigurationSheet) {
    Scenario const s = load("objects: {robots: {type: pogobot, geometry: disk}}\n");
    ASSERT_EQ(s.objects.size(), 1U);
    EXPECT_EQ(s.objects[0].nb, 1);
    EXPECT_EQ(s.objects[0].position_mm, std::nullopt);
    ObjectSpec const& made = s.objects[0].spec;
    RobotSpec const& spec = *made.robot;
    EXPECT_EQ(made.shape, kPogobotShape);
    EXPECT_EQ(made.body->linear_damping, 0.0F);
    EXPECT_EQ(made.body->angular_damping, 0.0F);
    EXPECT_EQ(made.body->density, 10.0F);
    EXPECT_EQ(made.body->friction, 0.3F);
    EXPECT_EQ(made.body->restitution, 0.5F);
    EXPECT_EQ(spec.max_linear_speed_mm_s, 100.0F);
    EXPECT_EQ(spec.max_angular_speed_rad_s, 1.0F);
    EXPECT_EQ(spec.linear_noise_stddev, 0.0F);
    EXPECT_EQ(spec.angular_noise_stddev, 0.0F);
    EXPECT_EQ(spec.motor_bias.min, 0);
    EXPECT_EQ(spec.photosensor_bias.max, 0);
    EXPECT_EQ(spec.photosensor_noise_stddev, 0.0F);
    EXPECT_EQ(spec.clock_drift_stddev_us, 0.0F);
    EXPECT_EQ(spec.ir.range_mm, 80.0F);
    EXPECT_EQ(spec.ir.queue_size, 20);
    EXPECT_TRUE(spec.rotate_leds_45_deg);
}

TEST(Scenario, TheArticlesExampleLoadsWithoutAWarning) {
    Warnings const warnings;
    Scenario const s =
        load_scenario(POGOSIM_SOURCE_DIR "/conf/simple.yaml", {.overrides = {}, .strict = true}, object_types());
    EXPECT_EQ(warnings.text(), "");
    EXPECT_EQ(s.view.window_width_px, 600);
    EXPECT_EQ(s.arena_file, "arenas/disk.csv");
    EXPECT_EQ(s.arena_surface_mm2, 1.0e6);
    EXPECT_EQ(s.output.data_filename, "frames/data.feather");
    EXPECT_EQ(s.seed, 0U);
    EXPECT_EQ(s.simulation_time_s, 50.0);
    EXPECT_EQ(s.view.gui_speed_up, 10.0);
    EXPECT_EQ(s.formation.name, "random");
    ASSERT_EQ(s.objects.size(), 2U);
    EXPECT_EQ(s.objects[0].category, "global_light");
    EXPECT_EQ(s.objects[0].type, "static_light");
    SpotSpec const lamp = spot_of(s.objects[0]);
    EXPECT_EQ(lamp.shape.kind, ShapeKind::global);
    EXPECT_EQ(lamp.value, 200);
    EXPECT_EQ(lamp.photo_start_at_s, 1.0F);
    EXPECT_EQ(s.objects[1].category, "robots");
    EXPECT_EQ(s.objects[1].nb, 100);
    RobotSpec const robot = *s.objects[1].spec.robot;
    EXPECT_EQ(s.objects[1].spec.shape.radius_mm, 26.5F);
    EXPECT_EQ(s.objects[1].spec.body->linear_damping, 0.3F);
    EXPECT_EQ(robot.max_angular_speed_rad_s, 2.0F);
    EXPECT_EQ(robot.ir.reception.law, ReceptionLaw::power);
    EXPECT_EQ(robot.ir.reception.alpha, 1.0e-6);
    EXPECT_EQ(robot.ir.reception.delta, 1.1897);
    EXPECT_EQ(s.source->tree.find("parameters")->find("run_duration_max")->scalar, "5000");
}

TEST(Scenario, EveryTopLevelKeyReachesItsMember) {
    Warnings const warnings;
    Scenario const s = load(kRobots + R"(
arena_file: a.csv
arena_surface: 2e5
arena_stretch: yes
boundary_condition: periodic
wall_friction: 0.1
wall_restitution: 0.9
walls_block_infrared: true
communication_ignore_occlusions: true
arena_temperature: 20
simulation_time: 12.5
time_step: 0.005
seed: 4294967295
user_code_timeout: 3
light_map_nb_bin_x: 10
light_map_nb_bin_y: 20
initial_formation: chessboard
initial_formation_root_object: robots
initial_formation_center: [1, .nan]
formation_min_space_between_neighbors: 3
formation_max_space_between_neighbors: 60
formation_attempts_per_point: 7
formation_max_restarts: 8
chessboard_distance_between_neighbors: 70
formation_cluster_at_center: off
formation_filename: f.csv
imported_formation_min_coords: [0, 1]
imported_formation_max_coords: [2, 3]
GUI: false
GUI_speed_up: 4
window_width: 100
window_height: 200
mm_to_pixels: 0.5
show_time: false
show_scale_bar: false
show_communication_channels: true
show_communication_channels_above_all: true
show_lateral_LEDs: false
show_light_levels: true
show_trajectory_traces: true
save_video_period: 0.5
frames_name: "f/{}.png"
delete_old_files: true
enable_data_logging: true
data_filename: d.feather
save_data_period: 0
data_logger_fields: [time, x]
data_logger_category: [robots]
data_logger_flush_row_count: 5
data_logger_led: true
enable_console_logging: true
console_filename: c.txt
log_format: minimal
progress_bar: true
result_filename_format: "r_{objects.robots.nb}.feather"
result_new_columns: [objects.robots.nb]
optimization: {algorithm: cmaes}
parameters: {any: thing}
)",
                            {.overrides = {}, .strict = true});
    EXPECT_EQ(warnings.text(), "");
    EXPECT_EQ(s.arena_file, "a.csv");
    EXPECT_EQ(s.arena_surface_mm2, 2e5);
    EXPECT_TRUE(s.arena_stretch);
    EXPECT_EQ(s.boundary, BoundaryCondition::periodic);
    EXPECT_EQ(s.walls.friction, 0.1F);
    EXPECT_EQ(s.walls.restitution, 0.9F);
    EXPECT_TRUE(s.walls.block_infrared);
    EXPECT_TRUE(s.ignore_occlusions);
    EXPECT_EQ(s.arena_temperature_c, 20.0);
    EXPECT_EQ(s.simulation_time_s, 12.5);
    EXPECT_EQ(s.time_step_s, 0.005);
    EXPECT_EQ(s.seed, 4294967295U);
    EXPECT_EQ(s.user_code_timeout_s, 3.0);
    EXPECT_EQ(s.light_map_columns, 10);
    EXPECT_EQ(s.light_map_rows, 20);
    EXPECT_EQ(s.formation.name, "chessboard");
    EXPECT_EQ(s.formation.root_object, "robots");
    EXPECT_EQ(s.formation.centre_mm.x, 1.0F);
    EXPECT_TRUE(std::isnan(s.formation.centre_mm.y));
    EXPECT_EQ(s.formation.min_space_mm, 3.0F);
    EXPECT_EQ(s.formation.max_space_mm, 60.0F);
    EXPECT_EQ(s.formation.attempts_per_point, 7);
    EXPECT_EQ(s.formation.max_restarts, 8);
    EXPECT_EQ(s.formation.chessboard_pitch_mm, 70.0F);
    EXPECT_FALSE(s.formation.cluster_at_centre);
    EXPECT_EQ(s.formation.filename, "f.csv");
    EXPECT_EQ(s.formation.imported_min, (Vec2{0, 1}));
    EXPECT_EQ(s.formation.imported_max, (Vec2{2, 3}));
    EXPECT_FALSE(s.view.gui);
    EXPECT_EQ(s.view.gui_speed_up, 4.0);
    EXPECT_EQ(s.view.window_width_px, 100);
    EXPECT_EQ(s.view.window_height_px, 200);
    EXPECT_EQ(s.view.mm_to_pixels, 0.5);
    EXPECT_FALSE(s.view.time || s.view.scale_bar || s.view.lateral_leds);
    EXPECT_TRUE(s.view.show_communication_channels && s.view.show_communication_channels_above_all &&
                s.view.light_levels && s.view.trails && s.view.delete_old_files);
    EXPECT_EQ(s.view.save_video_period_s, 0.5);
    EXPECT_EQ(s.view.frames_name, "f/{}.png");
    EXPECT_EQ(s.output.data_filename, "d.feather");
    EXPECT_EQ(s.output.save_data_period_s, 0.0);
    EXPECT_EQ(s.output.fields, (std::vector<std::string>{"time", "x"}));
    EXPECT_EQ(s.output.categories, std::vector<std::string>{"robots"});
    EXPECT_EQ(s.output.flush_row_count, 5);
    EXPECT_TRUE(s.output.led_column && s.output.enable_console_logging);
    EXPECT_EQ(s.output.console_filename, "c.txt");
    EXPECT_EQ(s.output.log_format, LogFormat::minimal);
    EXPECT_EQ(find_path(s.source->tree, "parameters.any")->scalar, "thing");
}

TEST(Scenario, EveryKeyOfViewReachesItsMember) {
    Scenario const s = load(
        "arena_file: a.csv\n"
        "view: {time: false, scale_bar: false, links: above, lateral_LEDs: false, "
        "light_levels: true, trails: true}\n");
    ViewOptions const expected{.time = false,
                               .scale_bar = false,
                               .links = LinkLayer::above,
                               .lateral_leds = false,
                               .light_levels = true,
                               .trails = true};
    EXPECT_EQ(static_cast<ViewOptions const&>(s.view), expected);
}

TEST(Scenario, OlderKeysOfTheViewHoldWhereItSaysNothing) {
    std::string const older = "arena_file: a.csv\nshow_time: false\nshow_communication_channels: true\n";
    EXPECT_EQ(load(older).view.links, LinkLayer::below);
    EXPECT_EQ(load(older + "show_communication_channels_above_all: true\n").view.links, LinkLayer::above);
    Scenario const s = load(older + "view: {links: hidden, trails: true}\n");
    EXPECT_EQ(s.view.links, LinkLayer::hidden);
    EXPECT_FALSE(s.view.time);
    EXPECT_TRUE(s.view.trails);
}

TEST(Scenario, EveryRobotKeyReachesItsMember) {
    Warnings const warnings;
    Scenario const s = load(R"(
objects:
  r:
    type: PogoBot
    geometry: Disk
    nb: 3
    x: 10
    y: 20.5
    radius: 30
    body_linear_damping: 1
    body_angular_damping: 2
    body_density: 1e12
    body_friction: 0.4
    body_restitution: 0.6
    max_linear_speed: 50
    max_angular_speed: 3
    linear_noise_stddev: 0.01
    angular_noise_stddev: 0.02
    angular_systematic_bias_domain: [-5, 6]
    photosensors_systematic_bias_domain: [-7, 8]
    photosensors_noise_stddev: 9
    temporal_noise_stddev: 11
    communication_radius: 133
    message_queue_size: 5
    rotate_LEDs_45_deg: false
    msg_success_rate: {type: static, rate: 0.25}
)",
                            {.overrides = {}, .strict = true});
    EXPECT_EQ(warnings.text(), "");
    ObjectConfig const& object = s.objects.at(0);
    EXPECT_EQ(object.category, "r");
    EXPECT_EQ(object.type, "pogobot");
    EXPECT_EQ(object.nb, 3);
    EXPECT_EQ(object.position_mm, (Vec2{10.0F, 20.5F}));
    EXPECT_EQ(object.line, "x.yaml:3");
    ObjectSpec const& made = object.spec;
    RobotSpec const& spec = *made.robot;
    EXPECT_EQ(made.shape.radius_mm, 30.0F);
    EXPECT_EQ(made.body->linear_damping, 1.0F);
    EXPECT_EQ(made.body->angular_damping, 2.0F);
    EXPECT_EQ(made.body->density, 1e12F);
    EXPECT_EQ(made.body->friction, 0.4F);
    EXPECT_EQ(made.body->restitution, 0.6F);
    EXPECT_EQ(spec.max_linear_speed_mm_s, 50.0F);
    EXPECT_EQ(spec.max_angular_speed_rad_s, 3.0F);
    EXPECT_EQ(spec.linear_noise_stddev, 0.01F);
    EXPECT_EQ(spec.angular_noise_stddev, 0.02F);
    EXPECT_EQ(spec.motor_bias.min, -5);
    EXPECT_EQ(spec.motor_bias.max, 6);
    EXPECT_EQ(spec.photosensor_bias.min, -7);
    EXPECT_EQ(spec.photosensor_bias.max, 8);
    EXPECT_EQ(spec.photosensor_noise_stddev, 9.0F);
    EXPECT_EQ(spec.clock_drift_stddev_us, 11.0F);
    EXPECT_EQ(spec.ir.range_mm, 133.0F);
    EXPECT_EQ(spec.ir.queue_size, 5);
    EXPECT_FALSE(spec.rotate_leds_45_deg);
    EXPECT_EQ(spec.ir.reception.law, ReceptionLaw::constant);
    EXPECT_EQ(spec.ir.reception.rate, 0.25);
}

TEST(Scenario, EveryLightKeyReachesItsMember) {
    Warnings const warnings;
    Scenario const s = load(R"(
objects:
  r: {type: pogobot, geometry: disk}
  l:
    type: static_light
    geometry: rectangle
    radius: 5
    body_width: 6
    body_height: 7
    side_length: 8
    light_mode: plane
    value: 100
    edge_value: 200
    gradient_radius: 300
    plane_angle: 1.5
    plane_half_span: 400
    photo_start_at: 2
    photo_start_duration: 3
    photo_start_value: 1000
    x: 11
    y: 12
)",
                            {.overrides = {}, .strict = true});
    EXPECT_EQ(warnings.text(), "");
    SpotSpec const spec = spot_of(s.objects.at(1));
    EXPECT_EQ(spec.shape, (Shape{ShapeKind::rectangle, 5, 6, 7, 8}));
    EXPECT_EQ(spec.mode, LightMode::plane);
    EXPECT_EQ(spec.value, 100);
    EXPECT_EQ(spec.edge_value, 200);
    EXPECT_EQ(spec.gradient_radius_mm, 300.0F);
    EXPECT_EQ(spec.plane_angle_rad, 1.5F);
    EXPECT_EQ(spec.plane_half_span_mm, 400.0F);
    EXPECT_EQ(spec.photo_start_at_s, 2.0F);
    EXPECT_EQ(spec.photo_start_duration_s, 3.0F);
    EXPECT_EQ(spec.photo_start_value, 1000);
    EXPECT_EQ(spec.centre_mm, (Vec2{11, 12}));
}

TEST(Scenario, LightsStandAtZeroAndAreUniformByDefault) {
    SpotSpec const spec = lamp("");
    EXPECT_EQ(spec.mode, LightMode::uniform);
    EXPECT_EQ(spec.centre_mm, Vec2{});
    EXPECT_EQ(spec.value, 10);
    EXPECT_EQ(spec.photo_start_at_s, -1.0F);
    EXPECT_EQ(lamp("    x: 5\n").centre_mm, (Vec2{5, 0}));
}

TEST(Scenario, EveryOrbitKeyReachesItsMember) {
    Warnings const warnings;
    SpotSpec const spec = spot_of(load(R"(
objects:
  r: {type: pogobot, geometry: disk}
  l:
    type: orbiting_static_light
    geometry: disk
    radius: 5
    light_mode: gradient
    value: 100
    photo_start_at: 2
    x: 11
    y: 12
    center_x: 13
    center_y: 14
    orbit_radius: 15
    orbit_angular_speed: -1.5
    orbit_phase: 3
)",
                                       {.overrides = {}, .strict = true})
                                      .objects.at(1));
    EXPECT_EQ(warnings.text(), "");
    EXPECT_EQ(spec.shape.radius_mm, 5.0F);
    EXPECT_EQ(spec.mode, LightMode::gradient);
    EXPECT_EQ(spec.value, 100);
    EXPECT_EQ(spec.photo_start_at_s, 2.0F);
    EXPECT_EQ(spec.centre_mm, (Vec2{13, 14}));
    EXPECT_EQ(spec.orbit.radius_mm, 15.0F);
    EXPECT_EQ(spec.orbit.angular_speed_rad_s, -1.5);
    EXPECT_EQ(spec.orbit.phase_rad, 3.0);
}

TEST(Scenario, OrbitsAreAroundXAndYAndStandStillByDefault) {
    std::string const head =
        "objects:\n  r: {type: pogobot, geometry: disk}\n  l: {type: orbiting_light, geometry: disk, x: 3, y: 4";
    SpotSpec const spec = spot_of(load(head + "}\n").objects.at(1));
    EXPECT_EQ(spec.centre_mm, (Vec2{3, 4}));
    EXPECT_EQ(spec.orbit.radius_mm, 0.0F);
    EXPECT_EQ(spec.orbit.angular_speed_rad_s, 0.0);
    EXPECT_EQ(spec.orbit.phase_rad, 0.0);
    ObjectConfig const object = load(head + ", center_y: 9, angular_speed: 2}\n").objects.at(1);
    EXPECT_EQ(spot_of(object).centre_mm, (Vec2{3, 9}));
    EXPECT_EQ(spot_of(object).orbit.angular_speed_rad_s, 2.0);
    EXPECT_EQ(object.type, "orbiting_static_light");
}

TEST(Scenario, EveryKeyOfARotatingRayReachesItsMember) {
    Warnings const warnings;
    Scenario const s = load(R"(
objects:
  r: {type: pogobot, geometry: disk}
  plain: {type: rotating_ray_of_light, geometry: global}
  l:
    type: Rotating_Ray_Of_Light
    geometry: triangle
    side_length: 8
    x: 11
    y: 12
    value: 100
    ray_half_width: 0.25
    angular_speed: -2
    white_frame_duration: 0.5
    white_frame_value: 20000
    photo_start_at: 1
    photo_start_duration: 2
)",
                            {.overrides = {}, .strict = true});
    EXPECT_EQ(warnings.text(), "");
    auto const spec = [&](std::size_t i) { return *s.objects.at(i).spec.lamp->get_if<RotatingRaySpec>(); };
    EXPECT_EQ(spec(2).shape.kind, ShapeKind::triangle);
    EXPECT_EQ(spec(2).shape.side_length_mm, 8.0F);
    EXPECT_EQ(spec(2).centre_mm, (Vec2{11, 12}));
    EXPECT_EQ(spec(2).value, 100);
    EXPECT_EQ(spec(2).half_width_rad, 0.25);
    EXPECT_EQ(spec(2).angular_speed_rad_s, -2.0);
    EXPECT_EQ(spec(2).white_frame_duration_s, 0.5);
    EXPECT_EQ(spec(2).white_frame_value, 20000);
    EXPECT_EQ(spec(2).photo_start_at_s, 1.0);
    EXPECT_EQ(spec(2).photo_start_duration_s, 2.0);
    EXPECT_EQ(spec(1).centre_mm, Vec2{});
    EXPECT_EQ(spec(1).value, 10);
    EXPECT_EQ(spec(1).half_width_rad, 0.1);
    EXPECT_EQ(spec(1).angular_speed_rad_s, 3.0);
    EXPECT_EQ(spec(1).white_frame_duration_s, 0.03);
    EXPECT_EQ(spec(1).white_frame_value, 32767);
    EXPECT_EQ(spec(1).photo_start_at_s, -1.0);
    EXPECT_EQ(spec(1).photo_start_duration_s, 1.0);
}

TEST(Scenario, EveryKeyOfAlternatingRaysReachesItsMember) {
    Warnings const warnings;
    Scenario const s = load(R"(
objects:
  r: {type: pogobot, geometry: disk}
  plain: {type: alternating_rays_of_light, geometry: global}
  l:
    type: alternating_rays_of_light
    geometry: rectangle
    body_width: 6
    body_height: 7
    x: 11
    y: 12
    value: 100
    ray_half_width: 0.25
    angular_speed: -2
    long_white_frame_duration: 0.5
    short_white_frame_duration: 0.25
    white_frame_value: 20000
)",
                            {.overrides = {}, .strict = true});
    EXPECT_EQ(warnings.text(), "");
    auto const spec = [&](std::size_t i) { return *s.objects.at(i).spec.lamp->get_if<AlternatingRaysSpec>(); };
    EXPECT_EQ(spec(2).shape.kind, ShapeKind::rectangle);
    EXPECT_EQ(spec(2).shape.width_mm, 6.0F);
    EXPECT_EQ(spec(2).shape.height_mm, 7.0F);
    EXPECT_EQ(spec(2).centre_mm, (Vec2{11, 12}));
    EXPECT_EQ(spec(2).value, 100);
    EXPECT_EQ(spec(2).half_width_rad, 0.25);
    EXPECT_EQ(spec(2).angular_speed_rad_s, -2.0);
    EXPECT_EQ(spec(2).long_white_frame_duration_s, 0.5);
    EXPECT_EQ(spec(2).short_white_frame_duration_s, 0.25);
    EXPECT_EQ(spec(2).white_frame_value, 20000);
    EXPECT_EQ(spec(1).value, 10);
    EXPECT_EQ(spec(1).half_width_rad, 0.1);
    EXPECT_EQ(spec(1).angular_speed_rad_s, 3.0);
    EXPECT_EQ(spec(1).long_white_frame_duration_s, 1.0);
    EXPECT_EQ(spec(1).short_white_frame_duration_s, 0.03);
    EXPECT_EQ(spec(1).white_frame_value, 32767);
}

TEST(Scenario, EveryShapeIsAShapeOfLight) {
    for (auto const& [name, kind] : {std::pair{"global", ShapeKind::global}, std::pair{"ARENA", ShapeKind::arena},
                                     std::pair{"disk", ShapeKind::disk}, std::pair{"Rectangle", ShapeKind::rectangle},
                                     std::pair{"triangle", ShapeKind::triangle}}) {
        Scenario const s = load(std::string("objects: {r: {type: pogobot, geometry: disk}, l: {type: static_light, "
                                            "geometry: ") +
                                name + "}}\n");
        EXPECT_EQ(spot_of(s.objects.at(1)).shape.kind, kind) << name;
    }
}

TEST(Scenario, UnknownLightModeWarnsAndIsStatic) {
    Warnings const warnings;
    EXPECT_EQ(lamp("    light_mode: disco\n").mode, LightMode::uniform);
    EXPECT_EQ(warnings.text(),
              "x.yaml:6: objects.lamp.light_mode: expected one of static, gradient, plane, found 'disco'; 'static' is "
              "used\n");
}

TEST(Scenario, MisspeltLightModeNamesTheNearest) {
    Warnings const warnings;
    EXPECT_EQ(lamp("    light_mode: gradiant\n").mode, LightMode::uniform);
    EXPECT_EQ(warnings.text(),
              "x.yaml:6: objects.lamp.light_mode: expected one of static, gradient, plane, found 'gradiant'; 'static' "
              "is used; did you mean 'gradient'?\n");
}

TEST(Scenario, EveryFormationIsAccepted) {
    for (std::string const& name : formation_names()) {
        EXPECT_EQ(load(kRobots + "formation_filename: f.csv\ninitial_formation: " + name + "\n").formation.name, name);
    }
}

TEST(Scenario, RealisticReceptionIsTheOlderLawWithItsOwnParameters) {
    for (ReceptionSpec const& spec : {reception("{type: realistic}"), reception("{type: realistic, alpha: 7}")}) {
        EXPECT_EQ(spec.law, ReceptionLaw::power);
        EXPECT_EQ(spec.alpha, 4e-6);
        EXPECT_EQ(spec.beta, 2.8096);
        EXPECT_EQ(spec.gamma, 2.3807);
        EXPECT_EQ(spec.delta, 1.2457);
    }
}

TEST(Scenario, ReceptionWithoutAKeyIsTheArticlesEquation) {
    for (ReceptionSpec const& spec : {robot("").ir.reception, reception("~")}) {
        ReceptionSpec const dynamic = reception("{type: dynamic}");
        EXPECT_EQ(spec.law, ReceptionLaw::article);
        EXPECT_EQ(spec.alpha, dynamic.alpha);
        EXPECT_EQ(spec.beta, dynamic.beta);
        EXPECT_EQ(spec.gamma, dynamic.gamma);
        EXPECT_EQ(spec.delta, dynamic.delta);
        EXPECT_EQ(spec.zeta, dynamic.zeta);
        EXPECT_EQ(spec.theta, dynamic.theta);
    }
}

TEST(Scenario, DynamicReceptionWithZetaOrThetaOrNothingIsTheArticlesLaw) {
    for (char const* map : {"{type: dynamic}", "{type: dynamic, zeta: 0.05720136}", "{type: dynamic, theta: 0.001}"}) {
        ReceptionSpec const spec = reception(map);
        EXPECT_EQ(spec.law, ReceptionLaw::article) << map;
        EXPECT_EQ(spec.alpha, 1.03215183) << map;
        EXPECT_EQ(spec.beta, 0.00073859) << map;
        EXPECT_EQ(spec.gamma, 3.14782227) << map;
        EXPECT_EQ(spec.delta, 3.52543753) << map;
        EXPECT_EQ(spec.zeta, 0.05720136) << map;
        EXPECT_EQ(spec.theta, 0.001) << map;
    }
    ReceptionSpec const spec = reception("{type: dynamic, alpha: 2, zeta: 3}");
    EXPECT_EQ(spec.law, ReceptionLaw::article);
    EXPECT_EQ(spec.alpha, 2.0);
    EXPECT_EQ(spec.zeta, 3.0);
    EXPECT_EQ(spec.beta, 0.00073859);
}

TEST(Scenario, DynamicReceptionWithOnlyTheFourParametersIsTheOlderLaw) {
    ReceptionSpec const spec = reception("{type: dynamic, beta: 3}");
    EXPECT_EQ(spec.law, ReceptionLaw::power);
    EXPECT_EQ(spec.alpha, 4e-6);
    EXPECT_EQ(spec.beta, 3.0);
    EXPECT_EQ(spec.gamma, 2.3807);
}

TEST(Scenario, NullCountsAsAbsent) {
    Scenario const s = load(kRobots + "time_step:\nseed: ~\ndata_logger_fields: null\nparameters:\n");
    EXPECT_EQ(s.time_step_s, 0.01);
    EXPECT_EQ(s.seed, std::nullopt);
    EXPECT_EQ(s.output.fields, std::nullopt);
}

TEST(Scenario, KeyWithoutAValueHasItsDefaultWithAWarning) {
    struct Case {
        std::string text;
        std::string warning;  // empty: none
    };
    std::string const expected = "x.yaml:6: time_step: expected a number above 0, at most 1 (s), found ";
    for (auto const& [text, warning] :
         {Case{"time_step:", expected + "nothing; the default is used, 0.01"},
          Case{"time_step:   # a comment", expected + "nothing; the default is used"},
          Case{"time_step: {batch_options: [0.1, 0.2]}",
               "x.yaml:6: time_step: has batch_options but no default_option; run it with "
               "pogobatch (a single run takes the default, 0.01)"},
          Case{"time_step: null", ""}, Case{"time_step: Null  # a comment", ""}, Case{"time_step: ~", ""},
          Case{"\xC3\xA9: 1\nseed: ~", ""}}) {
        Warnings const warnings;
        EXPECT_EQ(load(kRobots + text + "\n").time_step_s, 0.01);
        if (warning.empty()) {
            EXPECT_EQ(warnings.text().find("found nothing"), std::string::npos) << text;
        } else {
            EXPECT_EQ(warnings.lines().size(), 1U) << text;
            EXPECT_NE(warnings.text().find(warning), std::string::npos) << warnings.text();
        }
    }
}

TEST(Scenario, SectionsMayBeEmpty) {
    Warnings const warnings;
    load(kRobots + "parameters:\n");
    EXPECT_EQ(warnings.text(), "");
}

TEST(Scenario, NullBoundaryIsSolidWithAWarning) {
    for (char const* text : {"null", "'null'", ""}) {
        Warnings const warnings;
        EXPECT_EQ(load(kRobots + "boundary_condition: " + text + "\n").boundary, BoundaryCondition::solid);
        EXPECT_EQ(warnings.lines().size(), 1U) << text;
        EXPECT_NE(warnings.text().find("x.yaml:6: boundary_condition: expected solid or periodic"), std::string::npos);
    }
}

TEST(Scenario, ObjectsKeepTheOrderOfTheFile) {
    Scenario const s = load(
        "objects:\n  zeta: {type: pogobot, geometry: disk}\n  alpha: {type: pogobot, geometry: disk}\n"
        "  mid: {type: static_light, geometry: global}\n");
    ASSERT_EQ(s.objects.size(), 3U);
    EXPECT_EQ(s.objects[0].category, "zeta");
    EXPECT_EQ(s.objects[1].category, "alpha");
    EXPECT_EQ(s.objects[2].category, "mid");
}

TEST(Scenario, ConfigurationWithoutRobotsOnlyWarns) {
    for (char const* text : {"objects:\n", "objects: {}\n", "seed: 1\n",
                             "objects: {l: {type: static_light, geometry: "
                             "global}}\n"}) {
        Warnings const warnings;
        load(text);
        EXPECT_EQ(warnings.text(), "x.yaml:1: objects: there are no robots in this configuration; nothing will move\n")
            << text;
    }
}

TEST(Scenario, BatchOptionsGiveTheirDefaultOption) {
    Scenario const s = load(
        "arena_file: {batch_options: [a.csv, b.csv], default_option: c.csv}\n"
        "time_step: {batch_options: [0.1, 0.2]}\n"
        "objects:\n  robots:\n    type: pogobot\n    geometry: disk\n"
        "    nb: {batch_options: [100, 200], default_option: 50}\n"
        "    batch_hierarchical_options:\n      name: size\n      default: {radius: 20}\n      big: {radius: 40}\n");
    EXPECT_EQ(s.arena_file, "c.csv");
    EXPECT_EQ(s.time_step_s, 0.01);
    EXPECT_EQ(s.objects.at(0).nb, 50);
    EXPECT_EQ(s.objects.at(0).spec.shape.radius_mm, 20.0F);
}

TEST(Scenario, SetWinsOverTheFileAndOverItsOptions) {
    std::string const text = kRobots +
                             "    nb: {batch_options: [1, 2], default_option: 1}\n"
                             "    batch_hierarchical_options: {default: {max_linear_speed: 10}}\n";
    Scenario const s = load(text, {.overrides = {"objects.robots.nb=7", "objects.robots.max_linear_speed=20", "seed=3",
                                                 "seed=4", "time_step={default_option: 0.5, batch_options: [1]}"}});
    EXPECT_EQ(s.objects.at(0).nb, 7);
    EXPECT_EQ(s.objects.at(0).spec.robot->max_linear_speed_mm_s, 20.0F);
    EXPECT_EQ(s.seed, 4U);
    EXPECT_EQ(s.time_step_s, 0.5);
    EXPECT_EQ(s.source->tree.find("seed")->scalar, "4");
}

TEST(Scenario, ResolvedTreeKeepsUnknownKeysAndReadsBackTheSame) {
    Warnings const warnings;
    Scenario const s = load(kRobots + "mystery: {deep: [1, '1']}\narena_surface: 1.0e6\n");
    std::string const yaml = to_yaml(s.source->tree);
    EXPECT_NE(yaml.find("mystery:\n  deep:\n    - 1\n    - \"1\"\n"), std::string::npos);
    EXPECT_NE(yaml.find("arena_surface: 1.0e6\n"), std::string::npos);
    EXPECT_EQ(to_yaml(parse_yaml(yaml, "again.yaml")), yaml);
    Scenario const again = load(yaml);
    EXPECT_EQ(again.objects.at(0).category, "robots");
}

TEST(Scenario, NumbersInQuotesAreNumbers) {
    EXPECT_EQ(load(kRobots + "arena_surface: '1.0e5'\n").arena_surface_mm2, 1e5);
}

TEST(Scenario, PogobotNeedsNoGeometry) {
    Shape const plain = load("objects: {r: {type: pogobot}}\n").objects.at(0).spec.shape;
    EXPECT_EQ(plain.kind, ShapeKind::disk);
    EXPECT_EQ(plain.radius_mm, 26.5F);
    EXPECT_EQ(load("objects: {r: {type: pogobot, geometry: disk}}\n").objects.at(0).spec.shape, plain);
    EXPECT_EQ(load("objects: {r: {type: pogobot, radius: 30}}\n").objects.at(0).spec.shape.radius_mm, 30.0F);
    Shape const box = load("objects: {r: {type: pogobot, geometry: rectangle}}\n").objects.at(0).spec.shape;
    EXPECT_EQ(box.kind, ShapeKind::rectangle);
    EXPECT_EQ(box.width_mm, 10.0F);
}

TEST(Scenario, OtherTypesHaveARadiusOfTenMillimetres) {
    for (char const* type : {"pogobject", "active_object", "passive_object", "membrane", "static_light"}) {
        Scenario const s = load(std::string("objects: {r: {type: ") + type + ", geometry: disk}}\n");
        Shape const shape = s.objects.at(0).spec.lamp ? spot_of(s.objects[0]).shape : s.objects[0].spec.shape;
        EXPECT_EQ(shape.radius_mm, 10.0F) << type;
    }
}

TEST(Scenario, ArenaSurfaceMayBeThatOfTheFile) {
    EXPECT_EQ(load(kRobots + "arena_surface: file\n").arena_surface_mm2, std::nullopt);
    EXPECT_EQ(load(kRobots + "arena_surface: ~\n").arena_surface_mm2, 1.0e6);
    EXPECT_EQ(load_error(kRobots + "arena_surface: 0\n"),
              "x.yaml:6: arena_surface: expected a number above 0, at most 1000000000000 (mm2), or 'file', found 0");
    EXPECT_EQ(load_error(kRobots + "arena_surface: files\n"),
              "x.yaml:6: arena_surface: expected a number above 0, at most 1000000000000 (mm2), or 'file', found "
              "'files'");
    EXPECT_EQ(
        load_error(kRobots + "arena_surface: file\narena_stretch: true\n"),
        "x.yaml:7: arena_stretch: expected false, because 'arena_surface: file' keeps the size of the file; specify an "
        "area in mm2 to stretch it");
}

TEST(Scenario, CategoryThatStandsSeveralTimesIsAsManyEntries) {
    std::string const text =
        "objects:\n"
        "  robots: {type: pogobot}\n"
        "  lamp: {type: static_light, geometry: disk, x: 100, y: 100}\n"
        "  lamp: {type: static_light, geometry: disk, x: 200, y: 100}\n"
        "  box: {type: passive_object, geometry: disk}\n"
        "  lamp: {type: static_light, geometry: disk, x: 300, y: 100, nb: 2}\n";
    Warnings const warnings;
    Scenario const s = load(text);
    EXPECT_EQ(warnings.lines(),
              std::vector<std::string>{
                  "x.yaml:3: objects.lamp appears on lines 3, 4, 6; all of them are used, in the category "
                  "'lamp'. To avoid this warning, put them in a list under one key"});
    ASSERT_EQ(s.objects.size(), 5U);
    std::vector<float> places;
    for (ObjectConfig const& object : s.objects) {
        if (object.category == "lamp") {
            places.push_back(spot_of(object).centre_mm.x);
        }
    }
    EXPECT_EQ(places, (std::vector<float>{100.0F, 200.0F, 300.0F}));
    EXPECT_EQ(place_of(s, s.objects.at(2), ObjectSetting::x), "x.yaml:4: objects.lamp.1.x");

    // What the metadata say of it is the same world, in YAML that every reader understands.
    Warnings const none;
    Scenario const again = load(to_yaml(s.source->tree));
    EXPECT_EQ(none.text(), "");
    ASSERT_EQ(again.objects.size(), 5U);
    EXPECT_EQ(spot_of(again.objects.at(3)).centre_mm.x, 300.0F);
    EXPECT_EQ(again.objects.at(3).nb, 2);
}

TEST(Scenario, EachEntryOfACategoryIsCheckedAndCanBeSet) {
    std::string const text =
        "objects:\n  robots: {type: pogobot}\n  robots: {type: pogobot, nb: 3}\n  robots: {type: pogobot, nb: 7}\n";
    Warnings const warnings;
    Scenario const s = load(text, {.overrides = {"objects.robots.1.nb=5"}});
    EXPECT_EQ(s.objects.at(0).nb, 1);
    EXPECT_EQ(s.objects.at(1).nb, 5);
    EXPECT_EQ(s.objects.at(2).nb, 7);
    EXPECT_EQ(load_error(text, {.overrides = {"objects.robots.nb=5"}}),
              "--set 'objects.robots.nb=5': 'nb' is not an index of the list of length 3 at x.yaml:2; the first one is "
              "0");
    EXPECT_EQ(load_error(text + "  robots: {type: pogobot, nb: many}\n"),
              "x.yaml:5: objects.robots.3.nb: expected an integer from 0 to 10000000, found 'many'");
}

TEST(Scenario, CategoriesOfAnAlternativeMayStandSeveralTimesToo) {
    Warnings const warnings;
    Scenario const s = load(
        "objects:\n  robots: {type: pogobot}\n  batch_hierarchical_options:\n    default:\n"
        "      lamp: {type: static_light, geometry: global}\n      lamp: {type: static_light, geometry: arena}\n");
    EXPECT_EQ(s.objects.size(), 3U);
    EXPECT_EQ(warnings.lines().size(), 1U);
}

TEST(Scenario, KeyThatStandsTwiceElsewhereHasItsLastValue) {
    Warnings const warnings;
    Scenario const s = load(kRobots + "    nb: 2\n    nb: 3\nparameters: {objects: {a: 1, a: 2}}\n");
    EXPECT_EQ(s.objects.at(0).nb, 3);
    EXPECT_EQ(find_path(s.source->tree, "parameters.objects.a")->scalar, "2");
    EXPECT_EQ(warnings.lines().size(), 2U);
}

TEST(Scenario, SettingAKeyOfACategoryThatIsNotThereNamesThoseThatAre) {
    EXPECT_EQ(
        load_error(kRobots + "  box: {type: passive_object, geometry: disk}\n", {.overrides = {"objects.robot.nb=5"}}),
        "--set: objects: unknown category 'robot' (known: robots, box); did you mean 'robots'? To add a category, also "
        "set its type");
    Scenario const s = load(kRobots, {.overrides = {"objects.lamp.type=static_light", "objects.lamp.geometry=global"}});
    EXPECT_EQ(s.objects.at(1).type, "static_light");
}

TEST(Scenario, SensorsAreIdealUnlessTheConfigurationSaysOtherwise) {
    SensorSpec const ideal = robot("").sensors;
    EXPECT_EQ(ideal.model, SensorModel::ideal);
    EXPECT_EQ(ideal.photosensor_bits, 15);
    EXPECT_FALSE(ideal.imu_gravity);
    EXPECT_FALSE(ideal.imu_quantization);
    EXPECT_EQ(ideal.acceleration_noise_m_s2, 0.0F);
    EXPECT_EQ(ideal.acceleration, ImuAcceleration::robot);
    EXPECT_FALSE(robot("").battery);
}

TEST(Scenario, LampsWithLevelsOfTheSensorsConverterAreAWarning) {
    auto const warnings_of = [](std::string const& sensors, std::string const& lamp) {
        Warnings const warnings;
        load("objects:\n  robots: {type: pogobot, geometry: disk, " + sensors + "}\n  lamp: {type: " + lamp + "}\n");
        return warnings.text();
    };
    std::string const ten = "photosensors_bits: 10";
    std::string const spot = "static_light, geometry: global, ";
    EXPECT_EQ(
        warnings_of(ten, spot + "value: 800"),
        "x.yaml:3: objects.lamp: no lamp is brighter than 800, which light sensors of 10 bits, such as those of "
        "'robots', read as 25: the levels of lamps go up to 32767 with any photosensors_bits; perhaps they should "
        "be 32 times higher\n");
    EXPECT_NE(warnings_of("sensor_model: robot", spot + "value: 1023"), "");
    EXPECT_EQ(warnings_of(ten, spot + "value: 1024"), "");
    EXPECT_EQ(warnings_of(ten, spot + "value: 800, nb: 0"), "");
    EXPECT_EQ(warnings_of(ten + ", nb: 0", spot + "value: 800").find("no lamp"), std::string::npos);
    EXPECT_EQ(warnings_of(ten, spot + "value: 0"), "");
    EXPECT_EQ(warnings_of(ten, spot + "value: 0, light_mode: gradient, edge_value: 2000"), "");
    EXPECT_EQ(warnings_of(ten, spot + "value: 800, photo_start_at: 1"), "");
    EXPECT_EQ(warnings_of(ten, spot + "value: 800}\n  sun: {type: " + spot + "value: 20000"), "");
    EXPECT_EQ(warnings_of(ten, "rotating_ray_of_light, geometry: global, value: 800"), "");
    EXPECT_EQ(warnings_of("photosensors_bits: 13", spot + "value: 800"), "");
    EXPECT_EQ(warnings_of("radius: 26.5", spot + "value: 800"), "");
}

TEST(Scenario, SensorModelSetsTheDefaultsOfItsKeys) {
    SensorSpec const sensors = robot("    sensor_model: robot\n").sensors;
    EXPECT_EQ(sensors.photosensor_bits, 10);
    EXPECT_TRUE(sensors.imu_gravity);
    EXPECT_TRUE(sensors.imu_quantization);
    EXPECT_GT(sensors.acceleration_noise_m_s2, 0.0F);
    EXPECT_GT(sensors.angular_noise_rad_s, 0.0F);
    SensorSpec const own =
        robot("    photosensors_bits: 12\n    sensor_model: robot\n    imu_gravity: false\n").sensors;
    EXPECT_EQ(own.photosensor_bits, 12);
    EXPECT_FALSE(own.imu_gravity);
    EXPECT_TRUE(own.imu_quantization);
}

TEST(Scenario, ReadsTheBatteryOfARobot) {
    auto const battery = robot("    battery: {capacity_mah: 300, idle_ma: 80, motor_ma: 120, led_ma: 10}\n").battery;
    ASSERT_TRUE(battery);
    EXPECT_EQ(battery->capacity_mah, 300.0);
    EXPECT_EQ(battery->idle_ma, 80.0);
    EXPECT_EQ(battery->motor_ma, 120.0);
    EXPECT_EQ(battery->led_ma, 10.0);
    EXPECT_EQ(battery->initial_percent, 100.0);
    EXPECT_EQ(robot("    battery: {capacity_mah: 1}\n").battery->idle_ma, BatterySpec().idle_ma);
    EXPECT_FALSE(robot("    battery:\n").battery);
}

TEST(Scenario, RefusesWrongBatteriesAndSensors) {
    EXPECT_EQ(
        load_error(kRobots + "    battery: 250\n"),
        "x.yaml:6: objects.robots.battery: expected a map of keys, such as {capacity_mah: 250, idle_ma: 100}, found "
        "250");
    EXPECT_EQ(
        load_error(kRobots + "    battery: {capacity_mah: 0}\n"),
        "x.yaml:6: objects.robots.battery.capacity_mah: expected a number above 0, at most 1000000000 (mAh), found 0");
    EXPECT_NE(load_error(kRobots + "    battery: {idle_ma: 80}\n").find("capacity_mah"), std::string::npos);
    EXPECT_EQ(load_error(kRobots + "    photosensors_bits: 16\n"),
              "x.yaml:6: objects.robots.photosensors_bits: expected an integer from 1 to 15 (bits), found 16");
    EXPECT_EQ(load_error(kRobots + "    sensor_model: real\n"),
              "x.yaml:6: objects.robots.sensor_model: expected ideal or robot, found 'real'");
    EXPECT_EQ(load_error(kRobots + "    imu_acceleration: new\n"),
              "x.yaml:6: objects.robots.imu_acceleration: expected robot or original, found 'new'");
    Warnings const warnings;
    load(kRobots + "    battery: {capacity_mah: 250, idle_m: 3}\n");
    EXPECT_NE(warnings.text().find("did you mean 'idle_ma'?"), std::string::npos) << warnings.text();
}

TEST(Scenario, PassiveObjectsMembranesAndWallsMayBlockInfrared) {
    for (std::string const type : {"passive_object", "membrane", "rectmembrane"}) {
        Warnings const warnings;
        std::string const thing = "  it:\n    type: " + type + "\n    geometry: disk\n    blocks_infrared: ";
        EXPECT_TRUE(load(kRobots + thing + "true\n").objects.at(1).spec.body->blocks_infrared);
        EXPECT_EQ(load_error(kRobots + thing + "maybe\n"),
                  "x.yaml:9: objects.it.blocks_infrared: expected true or false, found 'maybe'");
        EXPECT_EQ(warnings.text(), "");
    }
    EXPECT_EQ(load_error("walls_block_infrared: 2\n" + kRobots),
              "x.yaml:1: walls_block_infrared: expected true or false, found 2");
    // Robots hide each other anyway.
    EXPECT_NE(load_error(kRobots + "    blocks_infrared: true\n", {.strict = true}).find("x.yaml:6: "),
              std::string::npos);
}

TEST(Scenario, LampsWithAPlaceMayCastShadows) {
    std::string const lamps[] = {
        "static_light\n    geometry: disk", "static_light\n    geometry: global\n    light_mode: gradient",
        "orbiting_static_light\n    geometry: rectangle\n    orbit_radius: 10",
        "rotating_ray_of_light\n    geometry: global", "alternating_rays_of_light\n    geometry: arena"};
    for (std::string const& type : lamps) {
        Warnings const warnings;
        std::string const it = kRobots + "  it:\n    type: " + type + "\n    x: 1\n    y: 2\n";
        EXPECT_TRUE(load(it + "    casts_shadows: true\n").objects.at(1).spec.lamp->casts_shadows) << type;
        EXPECT_FALSE(load(it).objects.at(1).spec.lamp->casts_shadows) << type;
        EXPECT_EQ(warnings.text(), "");
    }
    std::string const without = kRobots + "  it:\n    type: static_light\n    casts_shadows: true\n    geometry: ";
    for (std::string const geometry : {"global", "arena", "disk\n    light_mode: plane"}) {
        EXPECT_EQ(
            load_error(without + geometry + "\n"),
            "x.yaml:8: objects.it.casts_shadows: this light comes from no place, so nothing can be in its way; use "
            "a lamp with a place, such as light_mode gradient, or geometry disk");
    }
}

TEST(Scenario, WallsAndAllBodiesButRobotsOnWheelsAndMembranesBlockLight) {
    EXPECT_TRUE(load(kRobots).walls.block_light);
    EXPECT_FALSE(load("walls_block_light: false\n" + kRobots).walls.block_light);
    EXPECT_FALSE(load(kRobots).objects.at(0).spec.body->blocks_light);
    EXPECT_TRUE(load(kRobots + "    blocks_light: true\n").objects.at(0).spec.body->blocks_light);
    for (std::string const type : {"passive_object", "active_object", "pogobject", "membrane", "rectmembrane"}) {
        std::string const thing = kRobots + "  it:\n    type: " + type + "\n    geometry: disk\n";
        bool const is_membrane = type.ends_with("membrane");
        EXPECT_EQ(load(thing).objects.at(1).spec.body->blocks_light, !is_membrane) << type;
        std::string const other = is_membrane ? "true" : "false";
        EXPECT_EQ(load(thing + "    blocks_light: " + other + "\n").objects.at(1).spec.body->blocks_light, is_membrane)
            << type;
    }
}

TEST(Scenario, WallsThatAddEnergyGetAWarning) {
    Warnings const warnings;
    EXPECT_EQ(load("wall_restitution: 1.8\n" + kRobots).walls.restitution, 1.8F);
    EXPECT_NE(warnings.text().find("x.yaml:1: wall_restitution: at 1.8, above 1, walls add energy"), std::string::npos)
        << warnings.text();
    EXPECT_EQ(warnings.lines().size(), 1U);
    load("wall_restitution: 1\n" + kRobots);
    load("boundary_condition: periodic\nwall_restitution: 1.8\n" + kRobots);
    EXPECT_EQ(warnings.lines().size(), 1U) << warnings.text();
    EXPECT_EQ(load_error("wall_restitution: 18\n" + kRobots),
              "x.yaml:1: wall_restitution: expected a number from 0 to 10, found 18");
}

TEST(Scenario, TakesCopiesAndTimesOfTheOriginalSimulator) {
    EXPECT_EQ(load(kRobots).wall_copies, WallCopies::one_per_face);
    EXPECT_EQ(load("wall_message_copies: original\n" + kRobots).wall_copies, WallCopies::original);
    EXPECT_EQ(load(kRobots).output.row_timing, RowTiming::multiples);
    EXPECT_EQ(load("save_data_times: original\n" + kRobots).output.row_timing, RowTiming::original);
}
