//! The reference by itself: what mechanics conserves, closed forms, and what the literature prints.

mod elastic;
mod mechanisms;
mod rigid;
