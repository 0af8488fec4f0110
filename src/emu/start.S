// The first instructions of a firmware on the emulated processor, at address 0: they prepare memory, run constructors
// and call main(0, NULL). After its end, the robot stays where it is.
    .section .text.start, "ax", @progbits
    .globl _start
    .type _start, @function
_start:
    .option push
    .option norelax
    la gp, __global_pointer$
    .option pop
    la sp, __stack_top
    la tp, __tls_start

    // Data with initial values, unless they are in their place already.
    la t0, __data_source
    la t1, __data_start
    la t2, __data_end
    beq t0, t1, 2f
1:  bgeu t1, t2, 2f
    lw t3, 0(t0)
    sw t3, 0(t1)
    addi t0, t0, 4
    addi t1, t1, 4
    j 1b

    // Data without.
2:  la t1, __bss_start
    la t2, __bss_end
3:  bgeu t1, t2, 4f
    sw zero, 0(t1)
    addi t1, t1, 4
    j 3b

    // Constructors of C++.
4:  la s0, __init_array_start
    la s1, __init_array_end
5:  bgeu s0, s1, 6f
    lw t0, 0(s0)
    addi s0, s0, 4
    jalr t0
    j 5b

6:  li a0, 0
    li a1, 0
    call main
    .size _start, . - _start

    // exit() ends here, too.
    .weak _exit
    .type _exit, @function
_exit:
    j _exit
    .size _exit, . - _exit
