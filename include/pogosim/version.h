// Version of the interface a program was compiled with.
#ifndef POGOSIM_VERSION_H
#define POGOSIM_VERSION_H

#define POGOSIM_VERSION_MAJOR 0
#define POGOSIM_VERSION_MINOR 11
#define POGOSIM_VERSION_PATCH 0

/// "vX.Y.Z".
#define POGOSIM_VERSION_STRING "v0.11.0"
#define POGOSIM_VERSION POGOSIM_VERSION_STRING

/// Versions as numbers that compare: 1.2.3 is 1002003.
#define POGOSIM_VERSION_ENCODE(major, minor, patch) ((major)*1000000 + (minor)*1000 + (patch))
#define POGOSIM_VERSION_COMPILED \
    POGOSIM_VERSION_ENCODE(POGOSIM_VERSION_MAJOR, POGOSIM_VERSION_MINOR, POGOSIM_VERSION_PATCH)
#define POGOSIM_VERSION_ATLEAST(major, minor, patch) \
    (POGOSIM_VERSION_COMPILED >= POGOSIM_VERSION_ENCODE(major, minor, patch))

#endif
