# Address 0: calls workload(a0, a1), with a stack that ends with the memory, and stops with the result in a0.
    .section .start, "ax"
    .globl start
start:
    li sp, 131072
    call workload
    ecall
