/// @file
/// Pictures of recorded runs, as the window draws them: a host that has read a data file gives arrays, and gets pixels.
/// The package `pogosim` of Python makes films with this. Functions return a status of pogosim/host.h, and
/// pogosim_host_error() says what went wrong. A painter is used by one thread at a time.
#ifndef POGOSIM_PAINTER_H
#define POGOSIM_PAINTER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// Draws one recorded run.
typedef struct pogosim_painter pogosim_painter;

/// What does not change during a run. All of it is copied. Objects are in the order of all arrays of a moment.
struct pogosim_stage {
    /// YAML, a map of these keys, of which an unknown one is a mistake:
    ///   view       keys of a configuration that say what pictures show: `view`, and the older show_time and the like
    ///   options    keys of `view` that prevail over these; others are a mistake
    ///   periodic   true: what leaves the box around the outer wall comes back on the other side
    ///   leds       true: colours are those of head LEDs, which glow; false: they are shown as they are
    ///   light_map  columns and rows of the levels of light, over the box around the outer wall
    ///   kinds      a list, how objects look: `geometry` and its sizes, as objects have them in a configuration, and
    ///              is: body (no program), robot, wall (with a program), or membrane or robot_membrane, a ring of
    ///              parts. A wall is at `x` and `y`, mm; a membrane has `half_thickness`, mm, and `segments`: true if
    ///              it is a band
    ///   lamps      a list: `geometry` and its sizes, of the area that each can light
    char const* description;
    float const* corners_mm;        ///< shape (corners, 2): outlines of the arena, the outer wall first
    uint32_t const* corner_counts;  ///< shape (polygons): corners of each outline, at least 3
    size_t polygon_count;           ///< at least 1
    uint32_t const* kinds;          ///< shape (objects): index into the list `kinds`
    uint32_t const* ids;            ///< shape (objects): as in the data file, for labels and for a robot to follow
    uint32_t const* part_counts;    ///< shape (objects): parts of membranes, 0 of everything else
    size_t object_count;            ///< of the arrays of shape (objects)
};

/// Links between bodies. Their ends are in the box of a periodic arena, or beyond its border where they cross it.
struct pogosim_body_link {
    int32_t kind;       ///< enum pogosim_run_link_kind of pogosim/host.h
    int32_t is_pinned;  ///< not 0: `to` is a place in the arena, and gets a dot
    float from_mm[2];   ///< x and y of one end
    float to_mm[2];     ///< x and y of the other
    float load;         ///< -1, pushed, to 1, pulled
};

/// A pair of robots of which one hears the other.
struct pogosim_infrared_link {
    uint32_t sender;    ///< index of an object
    uint32_t listener;  ///< the same
    int32_t is_mutual;  ///< not 0: the other way round, too
};

/// A run at one time. Colours are 0xRRGGBB.
struct pogosim_moment {
    double time_s;          ///< that the picture says
    float const* poses;     ///< shape (objects, 3): x and y, mm; heading, rad. NaN: there is none
    uint32_t const* rgb;    ///< shape (objects)
    float const* parts_mm;  ///< shape (parts, 2): of membranes, in the order of objects
    float const* lamps_mm;  ///< shape (lamps, 2): where they are
    int16_t const* light;   ///< shape (rows, columns): levels of light, 0 to 32767; NULL: those of the moment before
    float const* trail_mm;  ///< shape (points, 2): where objects were, one object after the other, oldest first
    uint32_t const* trail_rgb;                           ///< shape (points): their colours there
    uint32_t const* trail_counts;                        ///< shape (objects): points of each; NULL: there are no trails
    uint32_t trail_fading;                               ///< trails fade over so many points
    struct pogosim_infrared_link const* infrared_links;  ///< shape (infrared links)
    size_t infrared_link_count;                          ///< how many robots hear another one
    struct pogosim_body_link const* body_links;          ///< shape (body links)
    size_t body_link_count;                              ///< springs, rods and hinges that hold
    float const* velocity_mm_s;  ///< shape (objects, 2), for arrows; NaN: it has none; NULL: none has
    float const* heat;  ///< shape (objects): what a heat map of a value shows, NaN: it has none; NULL: none has
    float heat_low;     ///< the value at which the colours of the heat map begin; NaN: there is no value
    float heat_high;    ///< the value at which they end
};

/// Makes a painter. `painter` is NULL on failure.
int pogosim_painter_open(struct pogosim_stage const* stage, pogosim_painter** painter);

/// What it shows, as far as that costs a host some work: "trails", "light_levels", "links" (infrared) or "velocities".
/// 1 or 0.
int pogosim_painter_shows(pogosim_painter const* painter, char const* part, int* is_shown);

/// Draws a moment; the whole arena is in the middle of the picture unless `view` says otherwise (follow, zoom). `rgb`:
/// height_px rows of width_px x 3 bytes, from the top left, each row `stride_bytes` behind the one before.
int pogosim_painter_draw(pogosim_painter* painter, struct pogosim_moment const* moment, int32_t width_px,
                         int32_t height_px, uint8_t* rgb, size_t stride_bytes);

/// Frees a painter. NULL does nothing.
void pogosim_painter_close(pogosim_painter* painter);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
