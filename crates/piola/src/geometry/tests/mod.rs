mod fill;
mod points;
mod region;
mod shape;
