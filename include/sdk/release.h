/// @file
/// Release of the SDK that these headers follow.
#ifndef POGOSIM_SDK_RELEASE_H
#define POGOSIM_SDK_RELEASE_H

#define RELEASE_VERSION "v2.7.1"

#endif
