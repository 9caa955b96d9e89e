mod concentric;
mod facets;
mod fill;
mod points;
mod region;
mod shape;
mod surroundings;
