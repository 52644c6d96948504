import java.awt.Component;
import java.awt.Container;
import java.awt.Rectangle;
import java.awt.Robot;
import java.awt.Toolkit;
import java.awt.Window;
import java.io.IOException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.StandardCopyOption;
import javax.imageio.ImageIO;
import javax.swing.JTable;
import javax.swing.SwingUtilities;

/** A Java agent that lives in an unchanged lcm-spy and writes down, twice a second, the table that its window shows. */
public class SpyTable {
    public static void premain(String folder) {
        Thread writer = new Thread(() -> run(Path.of(folder)));
        writer.setDaemon(true);
        writer.start();
    }

    private static void run(Path folder) {
        try {
            while (true) {
                Thread.sleep(500);
                SwingUtilities.invokeAndWait(() -> write(folder));
            }
        } catch (java.lang.reflect.InvocationTargetException | InterruptedException stopped) {
            stopped.printStackTrace();
        }
    }

    private static void write(Path folder) {
        for (Window window : Window.getWindows()) {
            JTable table = table(window);
            if (table == null || !window.isShowing())
                continue;
            try {
                Path fresh = folder.resolve("table.new");
                Files.writeString(fresh, text(table));
                Rectangle screen = new Rectangle(Toolkit.getDefaultToolkit().getScreenSize());
                ImageIO.write(new Robot().createScreenCapture(screen), "png", folder.resolve("screen.png").toFile());
                Files.move(fresh, folder.resolve("table.tsv"), StandardCopyOption.ATOMIC_MOVE);
            } catch (IOException | java.awt.AWTException failed) {
                failed.printStackTrace();
            }
        }
    }

    private static JTable table(Container container) {
        for (Component inner : container.getComponents()) {
            if (inner instanceof JTable)
                return (JTable) inner;
            JTable found = inner instanceof Container ? table((Container) inner) : null;
            if (found != null)
                return found;
        }
        return null;
    }

    private static String text(JTable table) {
        StringBuilder made = new StringBuilder();
        for (int column = 0; column < table.getColumnCount(); column++)
            made.append(table.getColumnName(column)).append(column + 1 < table.getColumnCount() ? "\t" : "\n");
        for (int row = 0; row < table.getRowCount(); row++)
            for (int column = 0; column < table.getColumnCount(); column++)
                made.append(table.getValueAt(row, column)).append(column + 1 < table.getColumnCount() ? "\t" : "\n");
        return made.toString();
    }
}
