/* A heavier rotor, and a motor that pushes one way, then the other: a second of simulated time, on any machine.
 *
 * Prints a digest of all joint angles and rates on the way and the angles at the end, as bits. */
#include "gimbal.h"

/* Of the machine: host.c or board/board.c. */
void print(const char *text);

#define STEP 1e-4
#define STEPS 5u
#define INTERVALS 2000u
#define JOINTS 3u

static void print_bits(uint64_t bits) {
    char text[18] = " ";
    for (int digit = 0; digit < 16; digit++) {
        text[1 + digit] = "0123456789abcdef"[(bits >> (60 - 4 * digit)) & 15];
    }
    text[17] = '\0';
    print(text);
}

static uint64_t bits_of(double value) {
    union { double value; uint64_t bits; } both = {.value = value};
    return both.bits;
}

/* FNV-1a, 64 bits. */
static uint64_t digest(uint64_t hash, uint64_t bits) {
    for (int byte = 0; byte < 8; byte++) {
        hash = (hash ^ ((bits >> (8 * byte)) & 255)) * 0x100000001b3u;
    }
    return hash;
}

static double torque(unsigned interval) {
    return interval < 600 ? 1e-4 : interval < 1200 ? -1e-4 : 0.0;
}

static GimbalStatus simulate(Gimbal *gimbal, uint64_t *hash, GimbalAngle angles[JOINTS]) {
    GimbalStatus status = gimbal_init(gimbal);
    if (status == GIMBAL_STATUS_OK) {
        status = gimbal_set_parameter(gimbal, GIMBAL_PARAMETER_ROTOR_MASS, 0.085);
    }
    for (unsigned interval = 0; interval < INTERVALS && status == GIMBAL_STATUS_OK; interval++) {
        status = gimbal_set_input(gimbal, GIMBAL_INPUT_TORQUE, torque(interval));
        if (status == GIMBAL_STATUS_OK) {
            status = gimbal_step(gimbal, STEP, STEPS);
        }
        for (unsigned joint = 0; joint < JOINTS && status == GIMBAL_STATUS_OK; joint++) {
            status = gimbal_read_joint(gimbal, joint, &angles[joint]);
            *hash = digest(digest(*hash, bits_of(angles[joint].position)), bits_of(angles[joint].rate));
        }
    }
    return status;
}

/* How many calls that make no sense are answered by another status than they should be. */
static int misuse(Gimbal *gimbal) {
    static Gimbal blank;
    const double nan = __builtin_nan(""), infinity = __builtin_inf();
    Gimbal *askew = (Gimbal *)((char *)gimbal + 1);
    GimbalAngle angle;
    int wrong = 0;
    wrong += gimbal_init(0) != GIMBAL_STATUS_BAD_POINTER;
    wrong += gimbal_init(askew) != GIMBAL_STATUS_BAD_POINTER;
    wrong += gimbal_step(0, STEP, STEPS) != GIMBAL_STATUS_BAD_POINTER;
    wrong += gimbal_step(askew, STEP, STEPS) != GIMBAL_STATUS_BAD_POINTER;
    wrong += gimbal_set_input(0, 0, 0.0) != GIMBAL_STATUS_BAD_POINTER;
    wrong += gimbal_set_parameter(0, 0, 0.0) != GIMBAL_STATUS_BAD_POINTER;
    wrong += gimbal_read_joint(0, 0, &angle) != GIMBAL_STATUS_BAD_POINTER;
    wrong += gimbal_read_joint(gimbal, 0, 0) != GIMBAL_STATUS_BAD_POINTER;
    wrong += gimbal_step(&blank, STEP, STEPS) != GIMBAL_STATUS_NOT_INITIALISED;
    wrong += gimbal_read_joint(&blank, 0, &angle) != GIMBAL_STATUS_NOT_INITIALISED;
    wrong += gimbal_read_joint(gimbal, JOINTS, &angle) != GIMBAL_STATUS_OUT_OF_RANGE;
    wrong += gimbal_set_input(gimbal, 1, 0.0) != GIMBAL_STATUS_OUT_OF_RANGE;
    wrong += gimbal_set_parameter(gimbal, 1, 0.0) != GIMBAL_STATUS_OUT_OF_RANGE;
    wrong += gimbal_set_input(gimbal, 0, nan) != GIMBAL_STATUS_BAD_NUMBER;
    wrong += gimbal_set_parameter(gimbal, 0, infinity) != GIMBAL_STATUS_BAD_NUMBER;
    wrong += gimbal_set_parameter(gimbal, 0, nan) != GIMBAL_STATUS_BAD_NUMBER;
    wrong += gimbal_set_parameter(gimbal, 0, 0.0) != GIMBAL_STATUS_BAD_NUMBER;
    wrong += gimbal_set_parameter(gimbal, 0, -0.085) != GIMBAL_STATUS_BAD_NUMBER;
    wrong += gimbal_set_parameter(gimbal, 0, 1e101) != GIMBAL_STATUS_BAD_NUMBER;
    wrong += gimbal_step(gimbal, nan, STEPS) != GIMBAL_STATUS_BAD_NUMBER;
    wrong += gimbal_step(gimbal, 0.0, STEPS) != GIMBAL_STATUS_BAD_NUMBER;
    /* None of it has done any harm. */
    wrong += gimbal_step(gimbal, STEP, STEPS) != GIMBAL_STATUS_OK;
    /* A step far too large ends the run, and every call after it says so until the gimbal is initialised anew. */
    GimbalStatus failure = gimbal_step(gimbal, 1e3, 100);
    wrong += failure == GIMBAL_STATUS_OK;
    wrong += gimbal_step(gimbal, STEP, STEPS) != failure;
    wrong += gimbal_read_joint(gimbal, 0, &angle) != failure;
    wrong += gimbal_init(gimbal) != GIMBAL_STATUS_OK;
    wrong += gimbal_step(gimbal, STEP, STEPS) != GIMBAL_STATUS_OK;
    return wrong;
}

int main(void) {
    static Gimbal gimbal;
    uint64_t hash = 0xcbf29ce484222325u;
    GimbalAngle angles[JOINTS];
    if (simulate(&gimbal, &hash, angles) != GIMBAL_STATUS_OK) {
        print("the simulation failed\n");
        return 1;
    }
    print("run f64 driven");
    print_bits(hash);
    for (unsigned joint = 0; joint < JOINTS; joint++) {
        print_bits(bits_of(angles[joint].position));
    }
    print("\n");
    if (misuse(&gimbal) != 0) {
        print("misuse was not noticed\n");
        return 1;
    }
    print("end\n");
    return 0;
}
