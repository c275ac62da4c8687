// Names of files: as they are in a folder that was dropped, and as an experiment file names them.

/** The name with its folders, where a folder was dropped. */
export function nameOf(file: File): string {
  const path = (file as File & { path?: string }).webkitRelativePath;
  return path ? path.split("/").slice(1).join("/") || file.name : file.name;
}

export function uniqueName(name: string, isTaken: (name: string) => boolean): string {
  if (!isTaken(name)) return name;
  const [, stem, ending] = /^(.*?)(\.[^.]*)?$/.exec(name) as unknown as [string, string, string | undefined];
  for (let number = 2; ; number++) {
    const other = `${stem} (${number})${ending ?? ""}`;
    if (!isTaken(other)) return other;
  }
}

/** Whether a name of an experiment file, which may be a pattern, means a file: by its whole name, or by its last part. */
export function matches(pattern: string, name: string): boolean {
  const last = (path: string) => path.split("/").at(-1) ?? path;
  const asExpression = (text: string) =>
    new RegExp(`^${text.replace(/[.+^${}()|\\]/g, "\\$&").replace(/\*/g, "[^/]*").replace(/\?/g, "[^/]")}$`);
  try {
    return asExpression(pattern).test(name) || (!/[*?]/.test(pattern) && last(pattern) === last(name));
  } catch {
    return pattern === name;
  }
}

/** Files of a drop, folders included. */
export async function filesOf(transfer: DataTransfer): Promise<File[]> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter((entry) => entry != null);
  if (!entries.some((entry) => entry.isDirectory)) return [...transfer.files];
  const found = await Promise.all(entries.map(filesIn));
  return found.flat().sort((one, other) => one.name.localeCompare(other.name));
}

async function filesIn(entry: FileSystemEntry): Promise<File[]> {
  if (entry.isFile) return [await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject))];
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const all: File[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return all;
    for (const each of some) if (!each.name.startsWith(".")) all.push(...(await filesIn(each)));
  }
}
