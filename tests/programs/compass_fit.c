// Fits the compass of examples/magnetic_compass to readings made up from ellipses that are known, and prints what it
// finds: a line for each of them. The robot does not move.
#include "compass.h"

typedef struct {
    float centre_x, centre_y, major, minor, rotation;  // counts, rad
    float sense;                                       // 1: towards y
    float arc;                                         // rad that the robot turns
} case_t;

static case_t const cases[] = {
    {0.0f, 0.0f, 160.0f, 140.0f, 0.0f, 1.0f, 12.5664f},         {425.0f, 425.0f, 160.0f, 140.0f, 0.0f, -1.0f, 12.5664f},
    {-3000.0f, 8000.0f, 300.0f, 100.0f, 0.7f, -1.0f, 12.5664f}, {50.0f, -20.0f, 200.0f, 200.0f, 0.0f, 1.0f, 6.2832f},
    {425.0f, 300.0f, 170.0f, 120.0f, 2.5f, -1.0f, 3.1416f},     {425.0f, 425.0f, 160.0f, 140.0f, 0.0f, -1.0f, 0.0f},
};

static void fit(case_t const* truth) {
    static compass_readings_t readings;
    compass_t compass = {0};
    int const count = 600;
    readings.count = 0;
    for (int i = 0; i < count; i++) {
        float const angle = truth->sense * truth->arc * (float)i / (float)count;
        float const a = truth->major * cosf(angle), b = truth->minor * sinf(angle);
        float const c = cosf(truth->rotation), s = sinf(truth->rotation);
        compass_add(&readings, (int16_t)lroundf(truth->centre_x + c * a - s * b),
                    (int16_t)lroundf(truth->centre_y + s * a + c * b));
    }
    bool const is_found = compass_fit(&readings, &compass);
    // The angle that the compass adds as the robot turns: of the reading i with respect to the first one.
    float worst = 0.0f;
    for (int i = 0; is_found && i < count; i++) {
        float const turned = truth->arc * (float)i / (float)count;
        float const error = compass_heading(&compass, readings.x[i], readings.y[i]) -
                            compass_heading(&compass, readings.x[0], readings.y[0]) - turned;
        worst = fmaxf(worst, fabsf(atan2f(sinf(error), cosf(error))));
    }
    printf("%d %.3f %.3f %.3f %.3f %.0f %.4f\n", is_found, (double)compass.centre_x, (double)compass.centre_y,
           (double)compass.major, (double)compass.minor, (double)compass.sense, (double)worst);
}

typedef struct {
    int unused;
} USERDATA;
DECLARE_USERDATA(USERDATA);
REGISTER_USERDATA(USERDATA);

void user_init(void) {
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        fit(&cases[i]);
    }
}

void user_step(void) {}

int main(void) {
    pogobot_init();
    pogobot_start(user_init, user_step);
    return 0;
}
