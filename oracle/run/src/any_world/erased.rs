//! The macro that erases the type of a world.

/// Declares a trait without the types of a world, and implements it for every world `W`. Each function is
/// written once, with the body for `W`.
macro_rules! erased {
    (
        $(#[$about:meta])*
        pub trait $erased:ident: $($bound:path),+;

        impl<W: World> for $implementor:ty {
            $(
                $(#[$doc:meta])*
                fn $name:ident(&$this:ident $(, $argument:ident: $kind:ty)* $(,)?) -> $result:ty $body:block
            )*
        }
    ) => {
        $(#[$about])*
        pub trait $erased: $($bound +)+ {
            $(
                $(#[$doc])*
                fn $name(&$this $(, $argument: $kind)*) -> $result;
            )*
        }

        impl<W: World> $erased for $implementor {
            $(fn $name(&$this $(, $argument: $kind)*) -> $result $body)*
        }
    };
}

pub(crate) use erased;
