// Prints all there is to print, the way programs for the robots do: %lu for uint32_t, which is `long` there.
#include "pogobase.h"

typedef struct {
    uint32_t large;
    int32_t negative;
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

static void print_numbers(void) {
    printf("%lu %lu\n", mydata->large, (uint32_t)7);
    printf("%ld %ld\n", mydata->negative, INT32_MIN);
    printf("[%5lu|%-5ld|%+ld|%08lx|%lX]\n", (uint32_t)42, (int32_t)-42, (int32_t)42, (uint32_t)0xBEEF,
           (uint32_t)0xBEEF);
    printf("%u %d %i %hu %hhd %lld %llu\n", 1u, -2, -3, (unsigned short)4, (signed char)-5, -6000000000LL,
           7000000000ULL);
    printf("%.2f %g %e %s %c %% %%lu\n", 1.5, -0.25, 1000.0, "text", 'c');
    printf("%*ld|%-*lu|%.*f\n", 6, (int32_t)-1, 4, (uint32_t)2, 1, 3.14159);
}

static void print_pieces(void) {
    // Each robot leaves its line open while the others write theirs.
    switch (pogobot_ticks) {
        case 0:
            printf("robot %u", pogobot_helper_getid());
            break;
        case 1:
            putchar(' ');
            break;
        case 2:
            puts("has a line");
            break;
        case 3:
            printf("a\n\nb\nkept ");
            break;
        case 4:
            printf("until now\n");
            break;
        default:
            break;
    }
}

static void print_long_line(void) {
    char text[2000];
    memset(text, 'x', sizeof(text) - 1);
    text[sizeof(text) - 1] = '\0';
    printf("%s%lu\n", text, (uint32_t)1);
}

static void print_without_end(void) {
    printf("the last words, without end of line");
}

void user_init(void) {
    mydata->large = 4000000000u;
    mydata->negative = -5;
}

void user_step(void) {
    print_pieces();
    if (pogobot_ticks == 5 && pogobot_helper_getid() == 0) {
        print_numbers();
        print_long_line();
        pogobot_helper_print_version();
        print_without_end();
    }
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
