mod concentric;
mod fill;
mod points;
mod region;
mod shape;
mod surroundings;
