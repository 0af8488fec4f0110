// Robots that keep something in their flash memory, or look for what an earlier run has left there.
#include "pogobase.h"

typedef struct {
    uint8_t unused;
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

_Static_assert(POGOBOT_USER_FLASH_PAGE_SIZE* POGOBOT_USER_FLASH_PAGE_COUNT == 1507328u, "1472 KiB");
_Static_assert(POGOBOT_USER_FLASH_START_OFFSET == 0x90000u, "behind the firmware");

static char kind[32] = "read";

static bool is(char const* name) {
    return strcmp(kind, name) == 0;
}

// Page p of a robot: its id and p in the first four bytes, then their sum.
static void write_mark(uint16_t page) {
    uint8_t data[POGOBOT_USER_FLASH_PAGE_SIZE];
    uint16_t const id = pogobot_helper_getid();
    memset(data, id + page, sizeof(data));
    memcpy(data, &id, sizeof(id));
    memcpy(data + sizeof(id), &page, sizeof(page));
    write_page_flash(page, data);
}

static void print_page(uint16_t page) {
    uint8_t data[POGOBOT_USER_FLASH_PAGE_SIZE];
    uint32_t sum = 0;
    read_page_flash(page, (char*)data);
    for (uint32_t i = 0; i < sizeof(data); i++) {
        sum += data[i];
    }
    printf("page %u: %u %u %u %u ..., sum %lu\n", page, data[0], data[1], data[2], data[3], (unsigned long)sum);
}

static void print_all(void) {
    uint8_t directions[3];
    uint16_t powers[3];
    pogobot_motor_dir_mem_get(directions);
    pogobot_motor_power_mem_get(powers);
    printf("motors: %u %u %u, %u %u %u\n", directions[0], directions[1], directions[2], powers[0], powers[1],
           powers[2]);
    print_page(0);
    print_page(1);
    print_page(POGOBOT_USER_FLASH_PAGE_COUNT - 1);
}

static void user_init(void) {
    uint8_t directions[3] = {1, 0, 1};
    uint16_t powers[3] = {500, 600, (uint16_t)(700 + pogobot_helper_getid())};
    if (is("write") || is("stop") || is("exit") || is("crash") || is("long")) {
        write_mark(0);
        write_mark(POGOBOT_USER_FLASH_PAGE_COUNT - 1);
        pogobot_motor_dir_mem_set(directions);
        pogobot_motor_power_mem_set(powers);
    } else if (is("read")) {
        print_all();
    } else if (is("erase")) {
        erase_write_section_flash();
        print_all();
    } else if (is("count")) {  // runs
        uint8_t page[POGOBOT_USER_FLASH_PAGE_SIZE];
        read_page_flash(1, (char*)page);
        page[0] = page[0] == 0xFF ? 1 : page[0] + 1;
        write_page_flash(1, page);
        printf("run %u\n", page[0]);
    } else if (is("forgetful")) {  // of the erase
        write_mark(7);
        uint8_t data[POGOBOT_USER_FLASH_PAGE_SIZE] = {0xF0};
        for (int i = 0; i < 5; i++) {
            data[1] = (uint8_t)i;
            write_page_flash(7, data);
        }
        print_page(7);
    } else if (is("careful")) {
        write_mark(7);
        erase_write_section_flash();
        write_mark(7);
        print_page(7);
    } else if (is("emulated_erase")) {
        uint8_t blank[POGOBOT_USER_FLASH_PAGE_SIZE];
        memset(blank, 0xFF, sizeof(blank));
        write_mark(7);
        write_page_flash(7, blank);
        print_page(7);
    }
}

static void user_step(void) {
    if (pogobot_ticks == 1 && is("long")) {
        printf("goes on\n");
    } else if (pogobot_ticks == 10 && is("stop")) {
        stop_simulation();
    } else if (pogobot_ticks == 10 && is("exit")) {
        exit(0);
    } else if (pogobot_ticks == 10 && is("crash")) {
        abort();
    }
}

static void robot_end(void) {
    if (is("write_at_end")) {
        write_mark(1);
    }
}

static void global_setup(void) {
    init_array_from_configuration(kind);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    pogobot_start(user_init, user_step, "walls");
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_robot_end, robot_end);
    return 0;
}
