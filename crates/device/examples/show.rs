//! Shows the devices of this machine, or a law as text: `show neo_hookean_stress cuda single`.

use piola_device::{Language, Precision, cuda, devices, laws};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let is = |word: &str| words.iter().any(|w| w == word);
    let language = match (is("cuda"), is("opencl")) {
        (true, _) => Language::Cuda,
        (_, true) => Language::OpenCl,
        _ => Language::C,
    };
    let precision = if is("single") { Precision::Single } else { Precision::Double };
    let laws = laws::all();
    match words.first().map(|name| laws.iter().find(|law| law.name == *name)) {
        Some(Some(law)) => print!("{}", law.text(language, precision)),
        Some(None) => {
            let names: Vec<&str> = laws.iter().map(|law| law.name.as_str()).collect();
            println!("there is no law `{}`; there are {}", words[0], names.join(", "));
        }
        None => {
            println!("CUDA driver: {}, NVRTC: {}", cuda::has_driver(), cuda::has_compiler());
            devices().iter().for_each(|device| println!("{device}"));
            laws.iter().for_each(|law| println!("{:4} operations  {}", law.operations(), law.name));
        }
    }
}
