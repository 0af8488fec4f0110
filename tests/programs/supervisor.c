// Looks at the world where robots may not, or sets a column as it should not, as parameters say.
#include "pogobase.h"

typedef struct {
    uint32_t unused;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

char place[16] = "";
char column[16] = "";

static void look(char const* here) {
    if (strcmp(place, here) == 0) {
        printf("%d\n", (int)pogosim_world_object_count());
    }
}

static bool send(void) {
    look("send");
    uint8_t byte = 1;
    return pogobot_infrared_sendShortMessage_omni(&byte, 1) == 0;
}

static void user_init(void) {
    percent_msgs_sent_per_ticks = 100;
    msg_tx_fn = send;
    look("user_init");
}

static void user_step(void) {
    look("user_step");
}

static void end(void) {
    look("end");
}

static void global_setup(void) {
    init_array_from_configuration(place);
    init_array_from_configuration(column);
    if (strcmp(column, "early") == 0) {
        pogosim_world_set_column("fitness", 1.0);
    }
}

static void create_data_schema(void) {
    data_add_column_double("fitness");
    data_add_column_string("text");
    data_add_column_int8("small");
    data_add_column_bool("flag");
}

static void global_step(void) {
    if (column[0] != '\0') {
        pogosim_world_set_column(column, 200);
    }
}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    SET_CALLBACK(callback_global_setup, global_setup);
    SET_CALLBACK(callback_create_data_schema, create_data_schema);
    SET_CALLBACK(callback_global_step, global_step);
    SET_CALLBACK(callback_robot_end, end);
    return 0;
}
