# zig's linker makes no bundles; a library can be loaded as well. It has no versions for libraries either.
foreach(language IN ITEMS C CXX)
    set(CMAKE_SHARED_MODULE_CREATE_${language}_FLAGS "-shared -Wl,-headerpad_max_install_names")
    set(CMAKE_SHARED_LIBRARY_CREATE_${language}_FLAGS "-shared -Wl,-headerpad_max_install_names")
    set(CMAKE_SHARED_LIBRARY_RUNTIME_${language}_FLAG "-Wl,-rpath,")  # CMake asks the Mac that it runs on
    # As for libraries: otherwise, zig names them after the path where it writes them.
    set(CMAKE_${language}_CREATE_SHARED_MODULE "<CMAKE_${language}_COMPILER> <LANGUAGE_COMPILE_FLAGS> \
<CMAKE_SHARED_MODULE_CREATE_${language}_FLAGS> <LINK_FLAGS> -o <TARGET> \
-Wl,-install_name,@rpath/`basename <TARGET>` <OBJECTS> <LINK_LIBRARIES>")
    unset(CMAKE_${language}_OSX_COMPATIBILITY_VERSION_FLAG)
    unset(CMAKE_${language}_OSX_CURRENT_VERSION_FLAG)
endforeach()
