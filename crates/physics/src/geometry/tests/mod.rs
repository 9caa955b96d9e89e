mod concentric;
mod facets;
mod fill;
mod points;
mod probe;
mod region;
mod shape;
mod surroundings;
