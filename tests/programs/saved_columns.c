// A program whose robots export every type of column, and sometimes nothing.
#include <stdio.h>

#include "pogobase.h"

typedef struct {
    uint32_t steps;
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

static void user_init(void) {}

static void user_step(void) {
    mydata->steps++;
}

static void create_data_schema(void) {
    data_add_column_int8("small");
    data_add_column_int16("negative");
    data_add_column_int32("steps");
    data_add_column_int64("large");
    data_add_column_float("single");
    data_add_column_double("exact");
    data_add_column_float16("half");
    data_add_column_bool("is_odd");
    data_add_column_string("name of it");
}

// Robot 1 leaves values out. Robot 2 has rows from its 20th step on.
static void export_data(void) {
    uint16_t id = pogobot_helper_getid();
    data_set_value_int32("steps", (int32_t)mydata->steps);
    if (id == 2 && mydata->steps < 20) {
        disable_data_export();
    } else {
        enable_data_export();
    }
    if (id == 1) {
        data_set_value_string("name of it", NULL);
        return;
    }
    data_set_value_int8("small", (int8_t)(id + 1));
    data_set_value_int16("negative", (int16_t)(-1000 - id));
    data_set_value_int64("large", INT64_C(1) << 40);
    data_set_value_float("single", 0.1f);
    data_set_value_double("exact", 0.1 + id);
    data_set_value_float16("half", 0.1f);
    data_set_value_bool("is_odd", id % 2 != 0);
    char name[32];
    snprintf(name, sizeof(name), id == 0 ? "r\xc3\xb6t,\n%d" : "\xff%d", id);
    data_set_value_string("name of it", name);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
