/* A generated gimbal: base, outer ring, inner ring and rotor, with a motor on the outer axis. SI units.
 * Written by `cargo xtask embedded` from embedded/c/src/lib.rs. Do not edit. */

#ifndef GIMBAL_H
#define GIMBAL_H

#include <stdint.h>

/**
 * Words of a `Gimbal`.
 */
#define GIMBAL_WORDS 226

/**
 * How a call ended.
 */
typedef enum GimbalStatus {
  /**
   * As it should.
   */
  GIMBAL_STATUS_OK = 0,
  /**
   * A pointer is null or not aligned.
   */
  GIMBAL_STATUS_BAD_POINTER = 1,
  /**
   * `gimbal_init` has not been called.
   */
  GIMBAL_STATUS_NOT_INITIALISED = 2,
  /**
   * There is no joint, parameter or input of this number.
   */
  GIMBAL_STATUS_OUT_OF_RANGE = 3,
  /**
   * A number is not finite, a step not positive, or a parameter one that the mechanism cannot have.
   */
  GIMBAL_STATUS_BAD_NUMBER = 4,
  /**
   * The state is no longer finite: the step is too large. From here on the gimbal fails until it is initialised
   * anew.
   */
  GIMBAL_STATUS_NOT_FINITE = 5,
  /**
   * The constraints cannot be met, likewise.
   */
  GIMBAL_STATUS_NO_CONVERGENCE = 6,
  /**
   * The pose is singular, likewise.
   */
  GIMBAL_STATUS_SINGULAR = 7,
  /**
   * A correction would be too large, likewise.
   */
  GIMBAL_STATUS_JUMP = 8,
} GimbalStatus;

/**
 * The joints.
 */
typedef enum GimbalJoint {
  /**
   * Of the outer ring in the base.
   */
  GIMBAL_JOINT_ALPHA = 0,
  /**
   * Of the inner ring in the outer.
   */
  GIMBAL_JOINT_BETA = 1,
  /**
   * Of the rotor in the inner ring, continuous over its turns.
   */
  GIMBAL_JOINT_PHI = 2,
} GimbalJoint;

/**
 * The parameters.
 */
typedef enum GimbalParameter {
  /**
   * kg.
   */
  GIMBAL_PARAMETER_ROTOR_MASS = 0,
} GimbalParameter;

/**
 * The inputs.
 */
typedef enum GimbalInput {
  /**
   * Of the motor on the outer axis, N m.
   */
  GIMBAL_INPUT_TORQUE = 0,
} GimbalInput;

/**
 * A gimbal, in memory of the caller's. What is in it is nobody's business.
 *
 * A gimbal that was never initialised is recognised if its memory is zero.
 */
typedef struct Gimbal {
  /**
   * Private.
   */
  uint64_t words[GIMBAL_WORDS];
} Gimbal;

/**
 * Where a joint is and how fast it turns.
 */
typedef struct GimbalAngle {
  /**
   * rad.
   */
  double position;
  /**
   * rad/s.
   */
  double rate;
} GimbalAngle;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Puts a gimbal at its start, with all parameters and inputs at their defaults.
 *
 * # Safety
 * The pointer is null, or points to memory of a `Gimbal` that nobody else uses meanwhile; so with all functions here.
 */
enum GimbalStatus gimbal_init(struct Gimbal *gimbal);

/**
 * Sets a parameter; from the next step on. What the model file would refuse, such as a mass that is not positive, is
 * refused with `BadNumber`, and the parameter keeps its value.
 *
 * # Safety
 * As for `gimbal_init`.
 */
enum GimbalStatus gimbal_set_parameter(struct Gimbal *gimbal,
                                       uint32_t parameter,
                                       double value);

/**
 * Sets an input, until it is set anew.
 *
 * # Safety
 * As for `gimbal_init`.
 */
enum GimbalStatus gimbal_set_input(struct Gimbal *gimbal, uint32_t input, double value);

/**
 * Advances by a number of steps of `dt` seconds, corrects the dependent coordinates and reads the joints.
 *
 * # Safety
 * As for `gimbal_init`.
 */
enum GimbalStatus gimbal_step(struct Gimbal *gimbal,
                              double dt,
                              uint32_t steps);

/**
 * Writes where a joint was after the last step.
 *
 * # Safety
 * As for `gimbal_init`; `angle` is null or points to memory of a `GimbalAngle`.
 */
enum GimbalStatus gimbal_read_joint(struct Gimbal *gimbal,
                                    uint32_t joint,
                                    struct GimbalAngle *angle);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* GIMBAL_H */
