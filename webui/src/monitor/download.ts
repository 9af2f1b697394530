/// Has the browser keep a file.
export function download(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  // The browser takes it on its own time.
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
