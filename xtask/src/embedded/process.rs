//! Running a command under a time limit.

use gyro_cli::failure::Failure;
use std::io::Read;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Runs a command for at most so long; whether it succeeded, and what it wrote on both streams.
pub(crate) fn within(limit: Duration, command: &mut Command) -> Result<(bool, String), Failure> {
    let name = command.get_program().to_string_lossy().into_owned();
    let failure = |e: std::io::Error| Failure::Run(format!("{name}: {e}"));
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(failure)?;
    let readers = [
        reader(child.stdout.take().expect("standard output is piped")),
        reader(child.stderr.take().expect("standard error is piped")),
    ];
    let status = wait(limit, &mut child).map_err(failure)?;
    let text: String = readers.into_iter().filter_map(|reader| reader.join().ok()).collect();
    match status {
        Some(status) => Ok((status.success(), text)),
        None => Err(Failure::Run(format!("{name} did not end within {} s\n{text}", limit.as_secs()))),
    }
}

/// Reads a stream to its end, on a thread of its own: a full pipe would hold the child up.
fn reader(mut stream: impl Read + Send + 'static) -> JoinHandle<String> {
    thread::spawn(move || {
        let mut text = Vec::new();
        // What was read before an error is all there is to show.
        let _ = stream.read_to_end(&mut text);
        String::from_utf8_lossy(&text).into_owned()
    })
}

/// How a child ended; none if it had to be ended.
fn wait(limit: Duration, child: &mut Child) -> std::io::Result<Option<ExitStatus>> {
    let end = Instant::now() + limit;
    while Instant::now() < end {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        thread::sleep(Duration::from_millis(20));
    }
    child.kill()?;
    child.wait()?;
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn what_does_not_end_is_ended() {
        let outcome = within(Duration::from_millis(100), Command::new("sleep").arg("60"));
        assert!(matches!(outcome, Err(Failure::Run(words)) if words.contains("did not end")));
        let (is_success, text) = within(Duration::from_secs(60), Command::new("echo").arg("end")).unwrap();
        assert_eq!((is_success, text.as_str()), (true, "end\n"));
    }
}
