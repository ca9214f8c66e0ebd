//! Methods that are chosen at run time, by their names: what follows from their table.

/// Makes [`Integrator`](super::Integrator) of the table, and `by_method!`, which goes from it to the type of a method.
/// The first token is a dollar sign, for the macro within.
macro_rules! methods {
    ($d:tt $($(#[doc = $doc:literal])* $kind:ident $name:literal $variant:ident = $type:ident, $order:literal;)+) => {
        /// Goes from an [`Integrator`](crate::integrate::Integrator) to the type of its method:
        /// `by_method!(integrator, fixed A => …, adaptive A => …, implicit => …)`, of which each expression may
        /// name the type `A` of an explicit method without or with an error estimate.
        #[macro_export]
        macro_rules! by_method {
            (@fixed $d type:ident $d a:ident $d then:expr, $d b:ident $d adaptive:expr, $d implicit:expr) => {{
                #[allow(unused_imports)]
                use $d crate::integrate::$d type as $d a;
                $d then
            }};
            (@adaptive $d type:ident $d a:ident $d fixed:expr, $d b:ident $d then:expr, $d implicit:expr) => {{
                #[allow(unused_imports)]
                use $d crate::integrate::$d type as $d b;
                $d then
            }};
            (@implicit $d type:ident $d a:ident $d fixed:expr, $d b:ident $d adaptive:expr, $d then:expr) => {
                $d then
            };
            ($d integrator:expr, fixed $d a:ident => $d fixed:expr, adaptive $d b:ident => $d adaptive:expr, implicit => $d implicit:expr $d(,)?) => {
                match $d integrator {
                    $($d crate::integrate::Integrator::$variant => {
                        by_method!(@$kind $type $d a $d fixed, $d b $d adaptive, $d implicit)
                    })+
                }
            };
        }

        /// A one-step method that is chosen at run time.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[cfg_attr(feature = "wire", derive(SerBin, DeBin))]
        pub enum Integrator {
            #[default]
            $($(#[doc = $doc])* $variant,)+
        }

        impl Integrator {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant),+];

            /// Its name on command lines and in model files.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),+ }
            }

            /// Its order: [`Method::ORDER`].
            pub const fn order(self) -> u32 {
                match self { $(Self::$variant => $order),+ }
            }

            /// Whether it has an error estimate, and so steps of its own length.
            pub fn is_adaptive(self) -> bool {
                by_method!(self, fixed _A => false, adaptive _A => true, implicit => true)
            }

            /// Whether it needs the derivatives of what it integrates.
            pub fn is_implicit(self) -> bool {
                by_method!(self, fixed _A => false, adaptive _A => false, implicit => true)
            }
        }

        impl core::fmt::Display for Integrator {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl core::str::FromStr for Integrator {
            type Err = ();

            fn from_str(name: &str) -> Result<Self, ()> {
                Self::ALL.iter().copied().find(|one| one.name() == name).ok_or(())
            }
        }
    };
}

pub(super) use methods;
