//! The number types of PLY.

macro_rules! kinds {
    ($($kind:ident $type:ty: $name:literal $other_name:literal;)*) => {
        /// A number type. `f64` holds each value of each of them exactly.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(super) enum Kind {
            $($kind),*
        }

        impl Kind {
            /// The type with this name; each has two.
            pub fn named(name: &str) -> Option<Self> {
                match name {
                    $($name | $other_name => Some(Self::$kind),)*
                    _ => None,
                }
            }

            pub fn bytes(self) -> usize {
                match self {
                    $(Self::$kind => size_of::<$type>(),)*
                }
            }

            /// The value of a word of text.
            pub fn parse(self, word: &str) -> Option<f64> {
                match self {
                    $(Self::$kind => word.parse::<$type>().ok().map(f64::from),)*
                }
            }

            /// The value of the bytes of a number, least significant first.
            pub fn decode(self, bytes: &[u8]) -> f64 {
                match self {
                    $(Self::$kind => bytes.try_into().map_or(f64::NAN, |bytes| <$type>::from_le_bytes(bytes).into()),)*
                }
            }
        }
    };
}

kinds! {
    I8 i8: "char" "int8";
    U8 u8: "uchar" "uint8";
    I16 i16: "short" "int16";
    U16 u16: "ushort" "uint16";
    I32 i32: "int" "int32";
    U32 u32: "uint" "uint32";
    F32 f32: "float" "float32";
    F64 f64: "double" "float64";
}

impl Kind {
    pub fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}
