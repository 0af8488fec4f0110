# What the SDK's tools/variables.mak and tools/common.mak are for robots, for firmware that the simulator runs on an
# emulated processor: Debian's compiler with the SDK's options, and picolibc as its C library.
TRIPLE := riscv64-unknown-elf
CPUFLAGS := -march=rv32im -mabi=ilp32 -D__vexriscv__
CC = $(TRIPLE)-gcc -std=gnu99
CFLAGS = -Os $(CPUFLAGS) -g3 -Wall -Wstrict-prototypes -fomit-frame-pointer -fno-builtin -fno-stack-protector \
    --specs=picolibc.specs
define compile
$(CC) -c $(CFLAGS) $(1) $< -o $@
endef
