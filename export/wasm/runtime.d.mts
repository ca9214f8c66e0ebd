/**
 * Numbers that are read: an array or a typed one. Wrong types are refused by a `TypeError`, wrong lengths and numbers that
 * are not finite by a `RangeError`, before anything is computed.
 */
export type Numbers = ArrayLike<number>;
/** Numbers that are written. */
export type Real = {Real};
/** Where a module comes from: its address, its bytes, or itself. */
export type Source = string | URL | BufferSource | WebAssembly.Module;

export type Parameter = {Parameter};
export type Input = {Input};
export type Method = {Method};
export type Status = 'not_finite' | 'no_convergence' | 'singular' | 'jump' | 'step_too_short' | 'too_many_steps' | 'stiff'
  | 'invalid_step' | 'invalid_time' | 'invalid_tolerance' | 'invalid_method';

/** A step or a correction that could not be made. */
export declare class Failure extends Error {
  readonly status: Status;
  /** When, s. */
  readonly t: number;
  readonly value: number;
  readonly limit: number;
  /** Which element of the state. */
  readonly index: number;
  /** The joint, coupler or driver. */
  readonly owner: string | null;
}

/** What is known of the mechanism. */
export interface About {
  readonly name: string;
  readonly real: 'f64' | 'f32';
  readonly hasSolver: boolean;
  readonly sizes: Readonly<Record<string, number>>;
  readonly parameters: readonly { readonly name: Parameter; readonly value: number }[];
  readonly inputs: readonly { readonly name: Input; readonly value: number }[];
  /** Each number of the joint state, as the table of a run names it. */
  readonly states: readonly { readonly name: string; readonly unit: string }[];
  /** The bodies of the maximal state. */
  readonly bodies: readonly string[];
  /** Places: `place.joint.HINGE`, `place.output.HAND` and so on. */
  readonly place: Readonly<Record<string, Readonly<Record<string, number>>>>;
}

export interface Options {
  /** `dop853` unless it says otherwise. */
  method?: Method;
  t?: number;
  /** The joint state at `t`; the assembled start if there is none. */
  state?: Numbers;
  /** Relative and absolute; 1e-8 unless it says otherwise. */
  tolerance?: number;
  relative?: number;
  absolute?: number;
  firstStep?: number;
  smallestStep?: number;
  largestStep?: number;
  /** Of steps, accepted and rejected; a whole number. */
  budget?: number;
  /** Steps between two corrections; a whole number, 1 unless it says otherwise. */
  correctEvery?: number;
}

/** What steps have cost, and what they have met. */
export interface Statistics {
  readonly accepted: number;
  readonly rejected: number;
  readonly corrections: number;
  readonly evaluations: number;
  readonly jacobians: number;
  readonly limitedByStability: number;
  readonly leaps: number;
  readonly fastestRate: number;
  readonly shortestStep: number;
  readonly longestStep: number;
}

/** Integrates joint coordinates, closes loops after each step, controls the error. Steps that fail throw `Failure`. */
export declare class Solver {
  readonly mechanism: Mechanism;
  /** The time, s. */
  readonly t: number;
  /** The joint state; it may be set, and the solver goes on from it. */
  get state(): Real;
  set state(numbers: Numbers);
  readonly statistics: Statistics;
  /** Begins anew. */
  restart(options?: Options): void;
  /** One step of fixed length, s. */
  step(h: number): void;
  /** One step under error control, at most to `tEnd`. */
  stepTowards(tEnd: number): void;
  /** Steps under error control to `tEnd`. */
  advanceTo(tEnd: number): void;
  /** Closes the loops of the state now. */
  correct(): void;
  /** The state at a time within the last step. */
  interpolate(t: number): Real;
  /** Says that parameters or inputs have changed. */
  changed(): void;
}

/**
 * A mechanism with its parameters and inputs. Functions of time t, s, and of a state return what they compute; an array
 * that they are given last is what the result holds before.
 */
export declare class Mechanism {
  private constructor();
  readonly about: About;
  /** To be given to `load` for a second one that need not be compiled again. */
  readonly module: WebAssembly.Module;
  readonly parameters: Readonly<Record<Parameter, number>>;
  readonly inputs: Readonly<Record<Input, number>>;
  setParameter(name: Parameter | number, value: number): void;
  setInput(name: Input | number, value: number): void;
  another(): Promise<Mechanism>;
  solver(options?: Options): Solver;
{functions}}

export declare const about: About;
/** The mechanism, from the module beside this file unless another source is given. */
export declare function load(source?: Source): Promise<Mechanism>;
