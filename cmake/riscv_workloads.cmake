# Compiles tests/riscv/program for the robots' processor, as a firmware (ELF):
#
#   pogosim_riscv_workloads(TARGET DEFINITION)
#
# TARGET gets the C preprocessor's DEFINITION with its path, if the robots' compiler is installed.
find_program(POGOSIM_RISCV_CC riscv64-unknown-elf-gcc)
mark_as_advanced(POGOSIM_RISCV_CC)

function(pogosim_riscv_workloads target definition)
    if(NOT POGOSIM_RISCV_CC)
        message(STATUS "Without riscv64-unknown-elf-gcc, ${target} has no compiled program")
        return()
    endif()
    set(folder "${PROJECT_SOURCE_DIR}/tests/riscv/program")
    set(program "${CMAKE_CURRENT_BINARY_DIR}/riscv_workloads")
    add_custom_command(OUTPUT "${program}.elf"
        COMMAND "${POGOSIM_RISCV_CC}" -march=rv32im -mabi=ilp32 -O2 -ffreestanding -nostdlib -Wall -Wextra
            -T "${folder}/memory.ld" "${folder}/start.S" "${folder}/workloads.c" -lgcc -o "${program}.elf"
        DEPENDS "${folder}/memory.ld" "${folder}/start.S" "${folder}/workloads.c" "${folder}/workloads.h" VERBATIM)
    target_sources(${target} PRIVATE "${program}.elf")
    target_compile_definitions(${target} PRIVATE ${definition}="${program}.elf")
endfunction()
