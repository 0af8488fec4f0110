/// @file
/// Version of the interface a program was compiled with.
#ifndef POGOSIM_VERSION_H
#define POGOSIM_VERSION_H

///@{
/// Version of Pogosim, major.minor.patch.
#define POGOSIM_VERSION_MAJOR 0
#define POGOSIM_VERSION_MINOR 11
#define POGOSIM_VERSION_PATCH 0
///@}

///@{
/// The version as a text, "vX.Y.Z".
#define POGOSIM_VERSION_STRING "v0.11.0"
#define POGOSIM_VERSION POGOSIM_VERSION_STRING
///@}

/// A version as a number that can be compared: 1.2.3 is 1002003.
#define POGOSIM_VERSION_ENCODE(major, minor, patch) ((major)*1000000 + (minor)*1000 + (patch))
/// The version of these headers as such a number.
#define POGOSIM_VERSION_COMPILED \
    POGOSIM_VERSION_ENCODE(POGOSIM_VERSION_MAJOR, POGOSIM_VERSION_MINOR, POGOSIM_VERSION_PATCH)
/// Whether these headers are of that version or a later one.
#define POGOSIM_VERSION_ATLEAST(major, minor, patch) \
    (POGOSIM_VERSION_COMPILED >= POGOSIM_VERSION_ENCODE(major, minor, patch))

#endif
