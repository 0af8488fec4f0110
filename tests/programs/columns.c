// A column of each type, values at the ends of their ranges, cells and rows left out.
#include "pogobase.h"

typedef struct {
    uint32_t exports;
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

bool hide_odd_robots = false;

void user_init(void) {}

static void create_data_schema(void) {
    data_add_column_int8("i8");
    data_add_column_int16("i16");
    data_add_column_int32("i32");
    data_add_column_int64("i64");
    data_add_column_double("f64");
    data_add_column_string("text");
    data_add_column_bool("flag");
    data_add_column_float16("f16");
    data_add_column_float("f32");
    data_add_column_int32("never_set");
}

static void set_low_values(void) {
    data_set_value_int8("i8", INT8_MIN);
    data_set_value_int16("i16", INT16_MIN);
    data_set_value_int32("i32", INT32_MIN);
    data_set_value_int64("i64", INT64_MIN);
    data_set_value_double("f64", -1.0e308);
    data_set_value_string("text", "");
    data_set_value_bool("flag", false);
    data_set_value_float16("f16", -1.0e6f);
    data_set_value_float("f32", -1.0e6f);
}

// In another order than the columns.
static void set_high_values(void) {
    data_set_value_float("f32", 1.0f / 3.0f);
    data_set_value_float16("f16", 1.0f / 3.0f);
    data_set_value_bool("flag", true);
    data_set_value_string("text", "h\xc3\xa9, \"quoted\"\n");
    data_set_value_double("f64", 0.1);
    data_set_value_int64("i64", INT64_MAX);
    data_set_value_int32("i32", INT32_MAX);
    data_set_value_int16("i16", INT16_MAX);
    data_set_value_int8("i8", INT8_MAX);
}

// Robot 0 sets low values, robot 1 high ones, robot 2 nothing, the others the count of their calls.
static void export_data(void) {
    mydata->exports++;
    switch (pogobot_helper_getid()) {
        case 0:
            set_low_values();
            break;
        case 1:
            set_high_values();
            break;
        case 2:
            break;
        default:
            data_set_value_int32("i32", (int32_t)mydata->exports);
            break;
    }
    if (hide_odd_robots && pogobot_helper_getid() % 2 == 1) {
        disable_data_export();
    }
    // Robot 4 changes its mind; the export of robot 6 is never enabled after robot 5.
    if (hide_odd_robots && pogobot_helper_getid() == 4) {
        disable_data_export();
        enable_data_export();
    }
}

static void global_setup(void) {
    init_from_configuration(hide_odd_robots);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, NULL);
    pogobot_start(user_init, NULL, "others");
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
