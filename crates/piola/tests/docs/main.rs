//! The pages say what is there: paths exist, citations have a target, generated pages are fresh.

mod cases;
mod citations;
mod generated;
mod numbers;
mod pages;
mod paths;
mod promises;
mod rooms;
mod summary;
mod validation;
