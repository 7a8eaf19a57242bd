//! Knows no mechanism, only `Problem`.
