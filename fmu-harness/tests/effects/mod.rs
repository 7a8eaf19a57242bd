//! The price list of effects: its scenes are what they say, and what a scene does not call for costs nothing.

mod ladder;
mod unused;
