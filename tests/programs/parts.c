// Uses all parts that a robot's model may have or lack: motors, faces, light sensors, LEDs, flash memory.
#include "pogobase.h"

typedef struct {
    uint32_t heard;      // messages, however many faces heard each
    uint32_t faces;      // bit d: face d has heard one
    uint32_t from_face;  // of the sender: the last one's, 4 for all
    int16_t light[3];
} USERDATA;
DECLARE_USERDATA(USERDATA)
REGISTER_USERDATA(USERDATA)

int32_t right = 0;
int32_t left = 0;
int32_t back = 0;
bool asks_for_all = false;

void user_init(void) {
    init_from_configuration(right);
    init_from_configuration(left);
    init_from_configuration(back);
    init_from_configuration(asks_for_all);
    if (asks_for_all) {
        static char const page[POGOBOT_USER_FLASH_PAGE_SIZE] = {0};
        pogobot_led_setColors(255, 0, 0, 4);
        pogobot_motor_power_set(motorL, 9);
        write_page_flash(100, page);
        pogobot_infrared_sendLongMessage_uniSpe(ir_left, (uint8_t*)"x", 1);
    }
}

static void read_messages(void) {
    message_t message;
    while (pogobot_infrared_message_available()) {
        pogobot_infrared_recover_next_message(&message);
        ++mydata->heard;
        mydata->faces |= 1U << message.header._receiver_ir_index;
        mydata->from_face = message.header._sender_ir_index;
    }
}

void user_step(void) {
    pogobot_motor_power_set(motorR, (uint16_t)right);
    pogobot_motor_power_set(motorL, (uint16_t)left);
    pogobot_motor_power_set(motorB, (uint16_t)back);
    for (uint8_t sensor = 0; sensor < 3; ++sensor) {
        mydata->light[sensor] = pogobot_photosensors_read(sensor);
    }
    pogobot_infrared_update();
    read_messages();
    pogobot_infrared_sendLongMessage_omniGen((uint8_t*)"x", 1);
}

static void create_data_schema(void) {
    data_add_column_int32("heard");
    data_add_column_int32("faces");
    data_add_column_int32("from_face");
    data_add_column_int32("light_0");
    data_add_column_int32("light_2");
}

static void export_data(void) {
    data_set_value_int32("heard", (int32_t)mydata->heard);
    data_set_value_int32("faces", (int32_t)mydata->faces);
    data_set_value_int32("from_face", (int32_t)mydata->from_face);
    data_set_value_int32("light_0", mydata->light[0]);
    data_set_value_int32("light_2", mydata->light[2]);
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    pogobot_start(user_init, user_step, "ears");
    pogobot_start(user_init, user_step, "others");
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_export_data, export_data);
    return 0;
}
