//! Part of Meshtone.
