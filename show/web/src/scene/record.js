// The picture as a file: a PNG of what is shown, a video of the run.

function save(blob, name) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

const FORMATS = [['video/webm;codecs=vp9', 'webm'], ['video/webm', 'webm'], ['video/mp4', 'mp4']];

/** `compose` draws all that is to be seen onto a canvas. */
export function recorder(name, clock, compose) {
  const canvas = document.createElement('canvas');
  let running = null;
  const png = () => new Promise((done) => {
    compose(canvas);
    canvas.toBlob((blob) => { save(blob, `${name}.png`); done(blob); });
  });
  // From the start to the end, at the speed that is set; a second call ends it.
  const video = () => {
    if (running) { running.stop(); return null; }
    const format = FORMATS.find(([type]) => globalThis.MediaRecorder?.isTypeSupported(type));
    if (!format) return null;
    compose(canvas);
    const recording = new MediaRecorder(canvas.captureStream(30), { mimeType: format[0], videoBitsPerSecond: 8e6 });
    const parts = [];
    recording.ondataavailable = ({ data }) => parts.push(data);
    running = { stop: () => { if (recording.state !== 'inactive') recording.stop(); } };
    let last = -1;
    const watch = () => {
      if (recording.state === 'inactive') return;
      if (clock.t < last || !clock.playing) {
        clock.play(false);
        if (clock.t < last) clock.seek(clock.end);
        running.stop();
        return;
      }
      last = clock.t;
      compose(canvas);
      requestAnimationFrame(watch);
    };
    return new Promise((done) => {
      recording.onstop = () => {
        running = null;
        const blob = new Blob(parts, { type: format[0] });
        save(blob, `${name}.${format[1]}`);
        done(blob);
      };
      clock.seek(0);
      recording.start();
      clock.play(true);
      requestAnimationFrame(watch);
    });
  };
  return { png, video };
}
