// Robots that write down what they see: the measuring device of docs/figures/lamps.py.
#include "pogobase.h"

typedef struct {
    uint8_t unused;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

static void create_data_schema(void) {
    data_add_column_int16("light");
}

static void export_data(void) {
    data_set_value_int16("light", pogobot_photosensors_read(0));
}

static void user_init(void) {}

static void user_step(void) {}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
