//! The reference by itself.
