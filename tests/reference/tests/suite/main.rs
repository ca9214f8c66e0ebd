//! Reference solutions against laws and against each other. One program: each of its parts would compile them anew.

mod bearings;
mod chain;
mod lagrange;
mod reduced;
mod scenes;
