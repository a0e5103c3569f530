//! Finds the spherical wrist in a chain, whatever the frames it was described in.
