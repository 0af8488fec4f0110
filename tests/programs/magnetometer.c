// Robots that turn and record what their magnetometer says.
#include "pogobase.h"

typedef struct {
    int16_t x, y, z;
    int status;
    uint32_t waited_ms;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

uint16_t timeout_ms = 20;
bool turns = true;

static void user_init(void) {
    mydata->status = -1;
    printf("magnetometer: %u\n", magn_init());
    if (turns) {
        pogobot_motor_set(motorL, motorHalf);
    }
}

static void user_step(void) {
    uint32_t const before = current_time_milliseconds();
    magn_begin();
    mydata->status = magn_read_XYZ(&mydata->x, &mydata->y, &mydata->z, timeout_ms);
    magn_end();
    mydata->waited_ms = current_time_milliseconds() - before;
}

static void create_data_schema(void) {
    data_add_column_int16("mag_x");
    data_add_column_int16("mag_y");
    data_add_column_int16("mag_z");
    data_add_column_int32("status");
    data_add_column_int32("waited_ms");
}

static void export_data(void) {
    data_set_value_int16("mag_x", mydata->x);
    data_set_value_int16("mag_y", mydata->y);
    data_set_value_int16("mag_z", mydata->z);
    data_set_value_int32("status", mydata->status);
    data_set_value_int32("waited_ms", (int32_t)mydata->waited_ms);
}

static void global_setup(void) {
    init_from_configuration(timeout_ms);
    init_from_configuration(turns);
}

int main(void) {
    pogobot_init();
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    pogobot_start(user_init, user_step);
    pogobot_start(user_init, user_step, "others");
    return 0;
}
