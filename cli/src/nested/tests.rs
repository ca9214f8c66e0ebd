use super::*;
use gyro_runner::{Coordinates, Correction, Sample};

type Heard = Result<Option<Answer>, Failure>;

fn heard(text: &[u8]) -> (Heard, usize) {
    let mut n_samples = 0;
    let outcome = listen(&mut &text[..], &mut |event: Event<'_>| {
        n_samples += usize::from(matches!(event, Event::Sample(_)));
    });
    (outcome, n_samples)
}

fn text(replies: &[Reply]) -> Vec<u8> {
    let mut text = Vec::new();
    replies.iter().for_each(|reply| protocol::write(&mut text, reply).unwrap());
    text
}

#[test]
fn replies_are_heard_to_their_end() {
    let sample = Reply::Sample(Sample::default());
    let done = Reply::Done(Summary { steps: 10, ..Summary::default() });
    let (outcome, n_samples) = heard(&text(&[sample.clone(), Reply::Progress(0.5), sample.clone(), done]));
    assert!(matches!(outcome, Ok(Some(Answer::Done(summary, None))) if summary.steps == 10));
    assert_eq!(n_samples, 2);
    let (outcome, _) = heard(&text(&[Reply::Unexplained("at t = 1 s".to_owned())]));
    assert!(matches!(outcome, Ok(Some(Answer::Unexplained(words))) if words == "at t = 1 s"));
    let (outcome, n_samples) = heard(&text(&[sample.clone(), Reply::Failed("at t = 0.5 s".to_owned())]));
    assert!(n_samples == 1 && matches!(outcome, Err(Failure::Run(words)) if words == "at t = 0.5 s"));
    assert!(heard(&text(&[sample])).0.unwrap().is_none(), "a program that was killed says nothing");
    assert!(matches!(heard(b"nonsense").0, Err(Failure::Run(_))));
}

#[test]
fn who_waits_for_another_build_says_so() {
    let folder = files::tests::Folder::new();
    let path = folder.0.join("lock");
    let (first, second) = (File::create(&path).unwrap(), File::create(&path).unwrap());
    let (sender, heard) = std::sync::mpsc::channel();
    let tell = |words: &str| sender.send(words.to_owned()).unwrap();
    wait_for(&first, tell).unwrap();
    assert!(heard.try_recv().is_err(), "nothing is said where nobody waits");
    std::thread::scope(|scope| {
        scope.spawn(|| wait_for(&second, tell).unwrap());
        assert!(heard.recv().unwrap().contains("another run is compiling"));
        first.unlock().unwrap();
    });
}

#[test]
fn a_package_is_named_by_its_contents() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/pendulum.toml");
    let top = gyro_codegen::generate("top.toml", &fs::read_to_string(page).unwrap()).unwrap();
    let module = |code: &str| Module { name: "top".to_owned(), code: code.to_owned(), ..top.clone() };
    let package = |code, precision, runs| Package::program(&module(code), precision, runs).name;
    let name = |code, precision| package(code, precision, None);
    assert_eq!(name("a", Precision::F64), name("a", Precision::F64));
    assert_ne!(name("a", Precision::F64), name("b", Precision::F64));
    assert_ne!(name("a", Precision::F64), name("a", Precision::F32));
    assert!(name("a", Precision::F64).starts_with("top-"));
    let runs = Some(Runs::with(Coordinates::Maximal, Correction::None));
    assert_ne!(name("a", Precision::F64), package("a", Precision::F64, runs));
    // A mechanism may have the name of whatever could be imported.
    let text = main(&module("a"), Precision::F64, None);
    assert!(text.lines().all(|line| !line.starts_with("use ")), "{text}");
}
