# Libraries come from build/cross/TARGET/prefix, and nowhere else. Programs, such as pkg-config, are this machine's.
set(CMAKE_FIND_ROOT_PATH "${pogosim_cross}/prefix")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_PREFIX_PATH "${pogosim_cross}/prefix")
set(ENV{PKG_CONFIG_LIBDIR} "${pogosim_cross}/prefix/lib/pkgconfig")
