/// @file
/// Version of the interface a program was compiled with.
#ifndef POGOSIM_VERSION_H
#define POGOSIM_VERSION_H

///@{
/// Version of Pogosim, major.minor.patch. It stands here alone: the build and the packages read it from these lines.
#define POGOSIM_VERSION_MAJOR 0
#define POGOSIM_VERSION_MINOR 11
#define POGOSIM_VERSION_PATCH 0
///@}

///@{
/// The version as a text, "vX.Y.Z".
#define POGOSIM_VERSION_STRING POGOSIM_VERSION_TEXT(POGOSIM_VERSION_MAJOR, POGOSIM_VERSION_MINOR, POGOSIM_VERSION_PATCH)
#define POGOSIM_VERSION POGOSIM_VERSION_STRING
///@}

/// @cond
// A version as such a text: 1, 2, 3 is "v1.2.3".
#define POGOSIM_VERSION_TEXT(major, minor, patch) \
    "v" POGOSIM_VERSION_QUOTED(major) "." POGOSIM_VERSION_QUOTED(minor) "." POGOSIM_VERSION_QUOTED(patch)
// A number as a text.
#define POGOSIM_VERSION_QUOTED(number) #number
/// @endcond

/// A version as a number that can be compared: 1.2.3 is 1002003.
#define POGOSIM_VERSION_ENCODE(major, minor, patch) ((major)*1000000 + (minor)*1000 + (patch))
/// The version of these headers as such a number.
#define POGOSIM_VERSION_COMPILED \
    POGOSIM_VERSION_ENCODE(POGOSIM_VERSION_MAJOR, POGOSIM_VERSION_MINOR, POGOSIM_VERSION_PATCH)
/// Whether these headers are of that version or a later one.
#define POGOSIM_VERSION_ATLEAST(major, minor, patch) \
    (POGOSIM_VERSION_COMPILED >= POGOSIM_VERSION_ENCODE(major, minor, patch))

#endif
