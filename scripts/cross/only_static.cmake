# Leaves the static libraries of elfutils, and a libdw.pc that names all that they need.
file(GLOB shared "${PREFIX}/lib/libelf*.so*" "${PREFIX}/lib/libdw*.so*" "${PREFIX}/lib/libasm*.so*")
file(REMOVE ${shared})
foreach(name IN ITEMS libdw libelf)
    file(WRITE "${PREFIX}/lib/pkgconfig/${name}.pc"
        "Name: ${name}\nDescription: reads debug information\nVersion: 0\nLibs: -L${PREFIX}/lib -ldw -lelf -lz\nCflags: -I${PREFIX}/include\n")
endforeach()
